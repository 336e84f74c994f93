#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/canonical_json.h"
#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/verb.h"
#include "geometry/asset_files.h"
#include "geometry/asset_library.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

// What the user asked for; the subcommands share it, as only one of them runs.
struct Options {
  std::string root;
  std::vector<std::string> files;
  std::string name;
  std::optional<std::string> category;
  std::string description;
  double scale = 1.0;
  double smooth_angle_deg = 30.0;
  bool force = false;
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

std::string size_text(const BoundingBox& box) {
  const Eigen::Vector3d mm = 1000.0 * box.size();
  return fmt::format("{:.1f} × {:.1f} × {:.1f} mm", mm.x(), mm.y(), mm.z());
}

std::string summary(const Asset& asset) {
  return fmt::format("{:<20} {:>7} triangles  {:>8.1f} KiB  {}", asset.name,
                     asset.mesh.triangles.size(), static_cast<double>(asset.bytes) / 1024.0,
                     size_text(asset.box));
}

Json to_json(const Asset& asset) {
  const Eigen::Vector3d size = asset.box.size();
  return {{"name", asset.name},
          {"category", asset.category},
          {"description", asset.description},
          {"triangles", asset.mesh.triangles.size()},
          {"vertices", asset.mesh.positions.size()},
          {"bytes", asset.bytes},
          {"size_m", {size.x(), size.y(), size.z()}},
          {"slots", asset.mesh.slot_names},
          {"mesh_sha256", asset.mesh_sha256},
          {"buffer_sha256", asset.buffer_sha256}};
}

int import_files(const Options& options) {
  if (!options.name.empty() && options.files.size() > 1) {
    return report({ErrorKind::kInput, "--name names one asset: import the files one by one"});
  }
  for (const std::string& file : options.files) {
    const std::string name = options.name.empty() ? name_from_file(file) : options.name;
    const Status imported = import_asset({.file = file,
                                          .root = options.library_root(),
                                          .name = name,
                                          .category = options.category.value_or(name),
                                          .description = options.description,
                                          .scale = options.scale,
                                          .smooth_angle_deg = options.smooth_angle_deg,
                                          .replace = options.force});
    if (!imported) return report(imported.error());
    const auto asset = read_asset(options.library_root() / name);
    if (!asset) return report(asset.error());
    fmt::print("{}\n", summary(*asset));
  }
  return 0;
}

int list_assets(const Options& options) {
  const auto library = AssetLibrary::open({options.library_root()});
  if (!library) return report(library.error());
  Json list = Json::array();
  for (const std::string& name : library->names()) {
    const auto asset = library->load(name);
    if (!asset) return report(asset.error());
    if (options.json) {
      list.push_back(to_json(**asset));
    } else {
      fmt::print("{}  {}\n", summary(**asset), (*asset)->description);
    }
  }
  if (options.json) fmt::print("{}", readable_json(list));
  return 0;
}

// Goes on after a damaged asset, so that one run finds them all.
int check_assets(const Options& options) {
  const auto library = AssetLibrary::open({options.library_root()});
  if (!library) return report(library.error());
  int exit_code = 0;
  int damaged = 0;
  for (const std::string& name : library->names()) {
    const auto asset = library->load(name);
    if (asset) continue;
    exit_code = report(asset.error());
    ++damaged;
  }
  fmt::print("{} assets in {}, {} damaged\n", library->names().size(),
             options.library_root().string(), damaged);
  return exit_code;
}

using Action = int (*)(const Options&);

CLI::App* add_action(CLI::App& verb, const std::string& name, const std::string& help,
                     const std::shared_ptr<Options>& options, const OnSelected& on_selected,
                     Action action) {
  CLI::App* added = verb.add_subcommand(name, help);
  added->add_option("--root", options->root, "The asset library's folder")
      ->default_str("assets beside the program");
  added->callback([options, on_selected, action] {
    on_selected([options, action] { return action(*options); });
  });
  return added;
}

void add_import_options(CLI::App& command, Options& options) {
  command.add_option("FILE", options.files, "OBJ files, z up")->required();
  command.add_option("--name", options.name, "Name of the asset; without it the file's");
  command.add_option("--category", options.category,
                     "Class of its labels; without it the asset's name; '' for a distractor");
  command.add_option("--description", options.description, "One line about the asset");
  command
      .add_option("--scale", options.scale, "Metres per unit of the file: 0.001 for millimetres")
      ->capture_default_str();
  command
      .add_option("--smooth-angle", options.smooth_angle_deg,
                  "Edges sharper than this, in degrees, are shaded sharp")
      ->capture_default_str();
  command.add_flag("--force", options.force, "Replace assets that exist");
  command.footer("Example: seedframe asset import bolt.obj --scale 0.001 --category hex_bolt");
}

}  // namespace

void add_asset_verb(CLI::App& app, const OnSelected& on_selected) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("asset", "Bring meshes in, list and check them");
  verb->require_subcommand(1);
  verb->footer("Example: seedframe asset import part.obj --scale 0.001");
  CLI::App* import = add_action(*verb, "import", "Measure, compress and keep OBJ meshes", options,
                                on_selected, import_files);
  add_import_options(*import, *options);
  CLI::App* list =
      add_action(*verb, "list", "What is in the library", options, on_selected, list_assets);
  list->add_flag("--json", options->json, "As JSON");
  list->footer("Example: seedframe asset list --json");
  CLI::App* check = add_action(*verb, "check", "Read every asset and report the damaged ones",
                               options, on_selected, check_assets);
  check->footer("Example: seedframe asset check --root my_assets");
}

}  // namespace seedframe
