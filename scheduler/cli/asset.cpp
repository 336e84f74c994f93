#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "assets/asset_check.h"
#include "assets/asset_files.h"
#include "assets/asset_import.h"
#include "assets/asset_library.h"
#include "assets/thumbnail.h"
#include "base/canonical_json.h"
#include "base/files.h"
#include "base/utf8.h"
#include "cli/asset_keypoints.h"
#include "cli/asset_report.h"
#include "cli/verb.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/progress.h"
#include "console/say.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

double metres_per(const std::string& unit) {
  return unit == "mm" ? 0.001 : unit == "cm" ? 0.01 : unit == "in" ? 0.0254 : 1.0;
}

// What the user asked for; the subcommands share it, as only one of them runs.
struct Options {
  std::string root;
  std::vector<std::string> files;
  std::vector<std::string> names;
  std::optional<std::string> category;
  std::string up;
  std::string unit;
  AssetImport import;
  AssetCheck check;
  KeypointArguments keypoints;
  bool json = false;

  /// Where assets are written: never among the program's own, unless they are named.
  fs::path written_root() const { return root.empty() ? own_assets() : fs::path(root); }

  /// Where they are read: the user's own, then the built-in ones.
  std::vector<fs::path> read_roots() const {
    if (!root.empty()) return {root};
    std::error_code error;
    std::vector<fs::path> roots;
    if (fs::is_directory(own_assets(), error)) roots.push_back(own_assets());
    roots.push_back(seedframe_home() / "assets");
    return roots;
  }
};

std::string joined(const std::vector<fs::path>& folders) {
  std::string text;
  for (const fs::path& folder : folders) {
    text += (text.empty() ? "" : " and ") + folder.string();
  }
  return text;
}

// "M12 bolt.v2.obj" becomes "M12_bolt_v2".
std::string name_from_file(const fs::path& file) {
  constexpr std::size_t kLongest = 64;
  std::string name;
  for (const char c : as_utf8(file.stem().string())) {
    const auto byte = static_cast<unsigned char>(c);
    const bool inside_a_character = (byte & 0xC0u) == 0x80u;
    if (!inside_a_character) name += is_asset_name(std::string(1, c)) ? c : '_';
  }
  return name.substr(0, kLongest);
}

Status draw_thumbnail(const fs::path& folder) {
  const auto asset = read_asset(folder);
  if (!asset) return forward_error(asset);
  return write_file_atomically(folder / asset_files::kThumbnail, thumbnail_png(asset->mesh));
}

AssetImport request_for(const Options& options, const fs::path& file) {
  AssetImport request = options.import;
  request.file = file;
  request.root = options.written_root();
  if (request.name.empty()) request.name = name_from_file(file);
  request.category = as_utf8(options.category.value_or(request.name));
  request.description = as_utf8(request.description);
  if (!options.up.empty()) request.up = options.up == "y" ? UpAxis::kY : UpAxis::kZ;
  if (!options.unit.empty()) request.scale = metres_per(options.unit);
  return request;
}

// One file's error, or lack of memory, is none of the others'.
Result<ImportReport> import_file(const Options& options, const std::string& file) {
  AssetImport request = request_for(options, file);
  StepProgress progress(file);
  request.on_step = [&progress](const std::string& step) { progress.begin(step); };
  try {
    auto imported = import_asset(request);
    if (imported || imported.error().message.find(file) != std::string::npos) return imported;
    return fail(imported.error().kind, "{}: {}", file, imported.error().message);
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::kEnvironment, "{}: there is not enough memory to import it", file);
  }
}

int import_files(const Options& options) {
  if (!options.import.name.empty() && options.files.size() > 1) {
    return report({ErrorKind::kInput, "--name names one asset: import the files one by one"});
  }
  Json reports = Json::array();
  std::size_t imported = 0;
  int failure = kExitOk;
  for (const std::string& file : options.files) {
    const auto found = import_file(options, file);
    if (!found) {
      const ExitCode code = exit_code(found.error().kind);
      const Json error = told_error(found.error().message, code);
      if (options.json) reports.push_back({{"file", as_utf8(file)}, {"error", error}});
      if (failure == kExitOk) failure = code;
      continue;
    }
    ++imported;
    if (options.json) {
      reports.push_back(import_json(*found));
    } else {
      say("{}", import_text(*found, !options.import.dry_run));
    }
  }
  if (options.json) {
    fmt::print("{}", readable_json(reports));
  } else if (options.root.empty() && imported > 0 && !options.import.dry_run) {
    say("a config finds it by 'asset_folders: [{}]'\n", options.written_root().string());
  }
  return failure != kExitOk && imported > 0 ? kExitSomeFailed : failure;
}

// Folders of assets, those that the user named or all of the libraries.
Result<std::vector<fs::path>> chosen_assets(const std::vector<fs::path>& roots,
                                            const std::vector<std::string>& chosen) {
  const auto library = AssetLibrary::open(roots);
  if (!library) return forward_error(library);
  std::vector<fs::path> folders;
  for (const std::string& name : chosen.empty() ? library->names() : chosen) {
    const auto folder = library->folder(name);
    if (!folder) return forward_error(folder);
    folders.push_back(*folder);
  }
  return folders;
}

int list_assets(const Options& options) {
  const auto folders = chosen_assets(options.read_roots(), options.names);
  if (!folders) return report(folders.error());
  Json list = Json::array();
  int exit_code = 0;
  for (const fs::path& folder : *folders) {
    const auto asset = read_asset_description(folder);
    if (!asset) {
      exit_code = report(asset.error());
    } else if (options.json) {
      list.push_back(list_json(*asset, folder));
    } else {
      say("{}\n", list_line(*asset, folder));
    }
  }
  if (options.json) {
    fmt::print("{}", readable_json(list));
  } else {
    say("{} assets in {}\n", folders->size(), joined(options.read_roots()));
  }
  return exit_code;
}

int draw_thumbnails(const Options& options) {
  const auto folders = chosen_assets({options.written_root()}, options.names);
  if (!folders) return report(folders.error());
  for (const fs::path& folder : *folders) {
    if (Status drawn = draw_thumbnail(folder); !drawn) return report(drawn.error());
    say("{}\n", (folder / asset_files::kThumbnail).string());
  }
  return 0;
}

// Goes on after a damaged asset, so that one run finds them all.
int check_assets(const Options& options) {
  const auto folders = chosen_assets(options.read_roots(), options.names);
  if (!folders) return report(folders.error());
  int exit_code = 0;
  int damaged = 0;
  for (const fs::path& folder : *folders) {
    const auto faults = check_asset(folder, options.check);
    for (const std::string& fault : faults) exit_code = report({ErrorKind::kCorrupt, fault});
    if (!faults.empty()) ++damaged;
  }
  say("{} assets in {}, {} damaged\n", folders->size(), joined(options.read_roots()), damaged);
  return exit_code;
}

int remove_assets(const Options& options) {
  const auto folders = chosen_assets({options.written_root()}, options.names);
  if (!folders) return report(folders.error());
  for (const fs::path& folder : *folders) {
    if (Status removed = remove_asset(folder); !removed) return report(removed.error());
    say("removed {}\n", folder.string());
  }
  return 0;
}

int show_keypoints(const Options& options) {
  return asset_keypoints(options.written_root(), options.keypoints);
}

using Action = int (*)(const Options&);

CLI::App* add_action(CLI::App& verb, const std::string& name, const std::string& help,
                     const std::shared_ptr<Options>& options, const OnSelected& on_selected,
                     Action action) {
  CLI::App* added = verb.add_subcommand(name, help);
  added->add_option("--root", options->root, "The asset library's folder")
      ->type_name("DIR")
      ->default_str("your own, ~/.local/share/seedframe/assets");
  added->callback([options, on_selected, action] {
    on_selected([options, action] {
      if (!options->root.empty()) return action(*options);
      if (const auto home = find_home(); !home) return report(home.error());
      if (!own_assets().empty()) return action(*options);
      return report({ErrorKind::kEnvironment,
                     "neither HOME nor XDG_DATA_HOME names a folder: say where the asset library "
                     "is with --root DIR"});
    });
  });
  return added;
}

void add_import_options(CLI::App& command, Options& options) {
  AssetImport& import = options.import;
  command.add_option("FILE", options.files, "OBJ, PLY, STL, OFF, glTF or GLB files")->required();
  command.add_option("--name", import.name, "Name of the asset; without it the file's");
  command.add_option("--category", options.category,
                     "Class of its labels; without it the asset's name; '' for a distractor");
  command.add_option("--description", import.description, "One line about the asset");
  CLI::Option* scale = command.add_option(
      "--scale", import.scale, "Metres per unit of the file, where --unit has no name for it");
  command.add_option("--unit", options.unit, "The file's unit; metres for glTF, else guessed")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}))
      ->excludes(scale);
  command.add_option("--up", options.up, "The file's axis that points up; y for glTF, else z")
      ->check(CLI::IsMember({"y", "z"}));
  command
      .add_option("--smooth-angle", import.smooth_angle_deg,
                  "Edges sharper than this, in degrees, are shaded sharp")
      ->capture_default_str();
  command
      .add_option("--pixels", import.levels.pixels,
                  "Pixels of its longest side in the nearest view; errors stay under 1/20 of one")
      ->capture_default_str();
  command
      .add_option("--levels", import.levels.most_levels,
                  "Coarser levels, at most; 0 to 8, each for views a quarter as large")
      ->capture_default_str();
  command
      .add_option("--fill-holes", import.repair.fill_holes, "Close holes of at most so many edges")
      ->capture_default_str();
  command.add_flag("--force", import.replace, "Replace assets that exist");
  command.add_flag("--dry-run,--check-only", import.dry_run, "Report only, write nothing");
  command.add_flag("--json", options.json, "The report as JSON");
  command.footer("Example: seedframe asset import bolt.stl --unit mm --category hex_bolt");
}

void add_keypoint_options(CLI::App& command, KeypointArguments& keypoints) {
  command.add_option("NAME", keypoints.asset, "The asset")->required();
  command.add_option("POINT", keypoints.points,
                     "NAME=X,Y,Z in metres, as the mesh has them; all of them, they replace those "
                     "that are there");
  command.add_option("--inside", keypoints.inside,
                     "Points within the mesh, such as joints: only other objects hide them");
  command.add_option("--line", keypoints.lines, "A-B: draw a line between them");
  command.add_option("--mirror", keypoints.mirrored, "A-B: a mirrored image swaps them");
  command.add_flag("--clear", keypoints.clear, "Remove all");
  command.footer(
      "Example: seedframe asset keypoints hex_bolt head=0,0,0.02875 tip=0,0,-0.02875 "
      "--line head-tip");
}

}  // namespace

void add_asset_verb(CLI::App& app, const OnSelected& on_selected) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("asset", "Bring meshes in, list, check and remove them");
  verb->require_subcommand(1);
  verb->footer("Example: seedframe asset import part.obj --unit mm");
  CLI::App* import = add_action(*verb, "import", "Repair, measure, compress and keep meshes",
                                options, on_selected, import_files);
  add_import_options(*import, *options);
  CLI::App* remove = add_action(*verb, "remove", "Remove assets from the library", options,
                                on_selected, remove_assets);
  remove->add_option("NAME", options->names, "The assets")->required();
  remove->footer("Example: seedframe asset remove bolt");
  CLI::App* list =
      add_action(*verb, "list", "What is in the library", options, on_selected, list_assets);
  list->add_option("NAME", options->names, "Only these assets");
  list->add_flag("--json", options->json, "As JSON");
  list->footer("Example: seedframe asset list --json");
  CLI::App* check = add_action(*verb, "check", "Hash, decode and measure every asset again",
                               options, on_selected, check_assets);
  check->add_option("NAME", options->names, "Only these assets");
  check->add_flag("--thorough", options->check.thorough,
                  "Measure the levels' errors with a guaranteed bound: half a minute an asset");
  check->footer("Example: seedframe asset check --root my_assets");
  CLI::App* keypoints = add_action(*verb, "keypoints", "Show or set an asset's named points",
                                   options, on_selected, show_keypoints);
  add_keypoint_options(*keypoints, options->keypoints);
  CLI::App* draw = add_action(*verb, "thumbnail", "Draw the thumbnails again", options, on_selected,
                              draw_thumbnails);
  draw->add_option("NAME", options->names, "Only these assets");
  draw->footer("Example: seedframe asset thumbnail gear");
}

}  // namespace seedframe
