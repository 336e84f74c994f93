#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "assets/asset_check.h"
#include "assets/asset_files.h"
#include "assets/asset_import.h"
#include "assets/asset_library.h"
#include "assets/thumbnail.h"
#include "base/canonical_json.h"
#include "base/files.h"
#include "cli/asset_keypoints.h"
#include "cli/asset_report.h"
#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/verb.h"
#include "image/png_file.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

// What the user asked for; the subcommands share it, as only one of them runs.
struct Options {
  std::string root;
  std::vector<std::string> files;
  std::vector<std::string> names;
  std::optional<std::string> category;
  std::string up;
  AssetImport import;
  AssetCheck check;
  KeypointArguments keypoints;
  bool json = false;

  fs::path library_root() const {
    return root.empty() ? seedframe_home() / "assets" : fs::path(root);
  }
};

// "M12 bolt.v2.obj" becomes "M12_bolt_v2".
std::string name_from_file(const fs::path& file) {
  std::string name = file.stem().string();
  for (char& c : name) {
    if (!is_asset_name(std::string(1, c))) c = '_';
  }
  return name;
}

/// The built-in assets of an installed program are not those of its user.
Status check_writable(const Options& options) {
  const fs::path root = options.library_root();
  if (!options.root.empty() || ::access(root.c_str(), W_OK) == 0) return {};
  return fail(ErrorKind::kInput,
              "you may not write to the built-in assets in {}: name a library of your own with "
              "--root DIR, and its folder in the config's asset_folders",
              root.string());
}

Status draw_thumbnail(const fs::path& folder) {
  constexpr int kSide = 256;
  const auto asset = read_asset(folder);
  if (!asset) return forward_error(asset);
  return write_file_atomically(folder / asset_files::kThumbnail,
                               encode_png(thumbnail(asset->mesh, kSide)));
}

int import_files(const Options& options) {
  if (!options.import.name.empty() && options.files.size() > 1) {
    return report({ErrorKind::kInput, "--name names one asset: import the files one by one"});
  }
  if (!options.import.dry_run) {
    if (Status may = check_writable(options); !may) return report(may.error());
  }
  Json reports = Json::array();
  for (const std::string& file : options.files) {
    AssetImport request = options.import;
    request.file = file;
    request.root = options.library_root();
    if (request.name.empty()) request.name = name_from_file(file);
    request.category = options.category.value_or(request.name);
    if (!options.up.empty()) request.up = options.up == "y" ? UpAxis::kY : UpAxis::kZ;
    const auto imported = import_asset(request);
    if (!imported) return report(imported.error());
    if (!request.dry_run) {
      const Status drawn = draw_thumbnail(request.root / request.name);
      if (!drawn) return report(drawn.error());
    }
    if (options.json) {
      reports.push_back(import_json(*imported));
    } else {
      fmt::print("{}", import_text(*imported, !request.dry_run));
    }
  }
  if (options.json) fmt::print("{}", readable_json(reports));
  return 0;
}

// Names of the library's assets, those that the user named or all.
Result<std::vector<std::string>> chosen_assets(const Options& options) {
  const auto library = AssetLibrary::open({options.library_root()});
  if (!library) return forward_error(library);
  const std::vector<std::string> names = options.names.empty() ? library->names() : options.names;
  for (const std::string& name : names) {
    if (const auto folder = library->folder(name); !folder) return forward_error(folder);
  }
  return names;
}

int list_assets(const Options& options) {
  const auto names = chosen_assets(options);
  if (!names) return report(names.error());
  Json list = Json::array();
  int exit_code = 0;
  for (const std::string& name : *names) {
    const fs::path folder = options.library_root() / name;
    const auto asset = read_asset_description(folder);
    if (!asset) {
      exit_code = report(asset.error());
    } else if (options.json) {
      list.push_back(list_json(*asset, folder));
    } else {
      fmt::print("{}\n", list_line(*asset, folder));
    }
  }
  if (options.json) fmt::print("{}", readable_json(list));
  return exit_code;
}

int draw_thumbnails(const Options& options) {
  if (Status may = check_writable(options); !may) return report(may.error());
  const auto names = chosen_assets(options);
  if (!names) return report(names.error());
  for (const std::string& name : *names) {
    const fs::path folder = options.library_root() / name;
    if (Status drawn = draw_thumbnail(folder); !drawn) return report(drawn.error());
    fmt::print("{}\n", (folder / asset_files::kThumbnail).string());
  }
  return 0;
}

// Goes on after a damaged asset, so that one run finds them all.
int check_assets(const Options& options) {
  const auto names = chosen_assets(options);
  if (!names) return report(names.error());
  int exit_code = 0;
  int damaged = 0;
  for (const std::string& name : *names) {
    const auto faults = check_asset(options.library_root() / name, options.check);
    for (const std::string& fault : faults) exit_code = report({ErrorKind::kCorrupt, fault});
    if (!faults.empty()) ++damaged;
  }
  fmt::print("{} assets in {}, {} damaged\n", names->size(), options.library_root().string(),
             damaged);
  return exit_code;
}

int show_keypoints(const Options& options) {
  return asset_keypoints(options.library_root(), options.keypoints);
}

using Action = int (*)(const Options&);

CLI::App* add_action(CLI::App& verb, const std::string& name, const std::string& help,
                     const std::shared_ptr<Options>& options, const OnSelected& on_selected,
                     Action action) {
  CLI::App* added = verb.add_subcommand(name, help);
  added->add_option("--root", options->root, "The asset library's folder")
      ->type_name("DIR")
      ->default_str("assets beside the program");
  added->callback([options, on_selected, action] {
    on_selected([options, action] {
      const auto home = options->root.empty() ? find_home() : fs::path();
      return home ? action(*options) : report(home.error());
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
  command.add_option("--scale", import.scale, "Metres per unit of the file: 0.001 for millimetres")
      ->capture_default_str();
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
  command.footer("Example: seedframe asset import bolt.stl --scale 0.001 --category hex_bolt");
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
  CLI::App* verb = app.add_subcommand("asset", "Bring meshes in, list and check them");
  verb->require_subcommand(1);
  verb->footer("Example: seedframe asset import part.obj --scale 0.001");
  CLI::App* import = add_action(*verb, "import", "Repair, measure, compress and keep meshes",
                                options, on_selected, import_files);
  add_import_options(*import, *options);
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
