#include "config/campaign_config.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <set>

#include "base/nearest_name.h"
#include "config/plan_sections.h"
#include "config/scene_sections.h"
#include "config/section_reader.h"

namespace seedframe {
namespace {

constexpr int kConfigVersion = 1;
constexpr long long kLargestSide = 16384;       // of an image, pixels
constexpr long long kMostFrames = 100'000'000;  // of a campaign

RenderConfig read_render(SectionReader& campaign, Diagnostics& errors) {
  RenderConfig render;
  const auto node = campaign.find("render");
  if (!node) return render;
  SectionReader section(*node, errors);
  render.width = static_cast<int>(section.integer("width", render.width, 1, kLargestSide));
  render.height = static_cast<int>(section.integer("height", render.height, 1, kLargestSide));
  render.samples = static_cast<int>(section.integer("samples", render.samples, 1, 1 << 20));
  render.max_bounces =
      static_cast<int>(section.integer("max_bounces", render.max_bounces, 0, 1024));
  render.filter_width_px = section.positive("filter_width_px", render.filter_width_px);
  render.clamp_indirect = section.constant("clamp_indirect", render.clamp_indirect);
  if (render.clamp_indirect < 0.0) {
    errors.add(node->find("clamp_indirect")->place(), "expected 0 (no limit) or more");
  }
  for (const std::string& pass : section.texts("passes")) {
    if (pass == "depth") {
      render.depth = true;
    } else if (pass == "normal") {
      render.normal = true;
    } else {
      errors.add(node->find("passes")->place(),
                 "unknown pass '" + pass + "'" + did_you_mean(pass, {"depth", "normal"}));
    }
  }
  section.refuse_other_keys();
  return render;
}

ImageConfig read_image(SectionReader& campaign, const std::filesystem::path& folder,
                       Diagnostics& errors) {
  ImageConfig image;
  const auto node = campaign.find("image");
  if (!node) return image;
  image.place = node->place();
  SectionReader section(*node, errors);
  image.display = section.text("display", image.display);
  image.view = section.text("view", image.view);
  image.look = section.text("look", image.look);
  image.exposure_stops = section.constant("exposure_stops", image.exposure_stops);
  image.gamma = section.positive("gamma", image.gamma);
  if (const auto ocio = section.find("ocio_config")) {
    if (ocio->is_scalar()) image.ocio_config = folder / ocio->text();
    std::error_code missing;
    if (!ocio->is_scalar() || !std::filesystem::is_regular_file(*image.ocio_config, missing)) {
      errors.add(ocio->place(), "expected the path of an OpenColorIO config, found " +
                                    ocio->description() + " (paths start at the config's folder)");
    }
  }
  section.refuse_other_keys();
  return image;
}

LabelSource read_label_source(const ConfigNode& node, Diagnostics& errors) {
  if (node.is_scalar() && node.text() == "geometry") return LabelSource::kTwin;
  if (!node.is_scalar() || node.text() != "render") {
    errors.add(node.place(), "expected 'render' or 'geometry', found " + node.description());
  }
  return LabelSource::kIndexPass;
}

/// A share between 0 and 1.
double read_share(SectionReader& section, const std::string& key, double fallback) {
  const double share = section.constant(key, fallback);
  if (!(share >= 0.0 && share <= 1.0)) {
    section.errors().add(section.node().find(key)->place(),
                         fmt::format("{} is a share from 0 to 1, found {}", key, share));
  }
  return share;
}

LabelConfig read_labels(SectionReader& root, Diagnostics& errors) {
  LabelConfig labels;
  const auto node = root.find("labels");
  if (!node) return labels;
  labels.place = node->place();
  if (node->is_scalar()) {  // just the source
    labels.source = read_label_source(*node, errors);
    return labels;
  }
  SectionReader section(*node, errors);
  if (const auto source = section.find("source")) {
    labels.source = read_label_source(*source, errors);
  }
  labels.check = section.flag("check", labels.check);
  labels.tolerance = read_share(section, "tolerance", labels.tolerance);
  labels.edge_tolerance = read_share(section, "edge_tolerance", labels.edge_tolerance);
  section.refuse_other_keys();
  return labels;
}

std::vector<std::filesystem::path> read_folders(SectionReader& section, const std::string& key,
                                                const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> folders;
  for (const std::string& text : section.texts(key)) {
    folders.push_back(folder / text);
    std::error_code missing;
    if (!std::filesystem::is_directory(folders.back(), missing)) {
      section.errors().add(
          section.node().find(key)->place(),
          "there is no folder '" + text + "' (paths start at the config's folder)");
    }
  }
  return folders;
}

void read_size(SectionReader& section, CampaignConfig& config) {
  config.seed = static_cast<std::uint64_t>(
      section.integer("seed", 0, 0, std::numeric_limits<long long>::max()));
  config.sweep = read_sweep(section);
  config.scenes = section.integer("scenes", 1, 1, kMostFrames) * config.sweep.size();
  config.frames_per_scene = section.integer("frames_per_scene", 1, 1, kMostFrames);
  if (config.scenes > kMostFrames || config.frame_count() > kMostFrames) {
    section.errors().add(
        section.node().place(),
        fmt::format("scenes × frames_per_scene (× the combinations of the sweep) must not "
                    "exceed {}",
                    kMostFrames));
  }
}

void read_graphs(SectionReader& section, CampaignConfig& config,
                 const std::filesystem::path& folder) {
  const auto node = section.find("graphs");
  if (!node) return;
  config.graphs = folder / section.text("graphs", "");
  std::error_code missing;
  if (!std::filesystem::is_regular_file(*config.graphs, missing)) {
    section.errors().add(node->place(), "expected a file of JSON lines, found " +
                                            node->description() +
                                            " (paths start at the config's folder)");
  }
  for (const char* key : {"scenes", "sweep"}) {
    if (const auto other = section.node().find(key)) {
      section.errors().add(other->place(),
                           fmt::format("{} and graphs exclude each other: each line of graphs is a "
                                       "scene",
                                       key));
    }
  }
}

void read_categories(SectionReader& section, CampaignConfig& config) {
  config.categories = section.texts("categories");
  std::set<std::string> seen;
  for (const std::string& category : config.categories) {
    if (!seen.insert(category).second) {
      section.errors().add(section.node().find("categories")->place(),
                           "the category '" + category + "' stands twice");
    }
  }
  constexpr std::size_t kMostCategories = 255;  // semantic.png has 8 bits
  if (config.categories.size() > kMostCategories) {
    section.errors().add(section.node().find("categories")->place(),
                         fmt::format("at most {} categories", kMostCategories));
  }
}

/// It becomes the name of a folder.
std::string read_campaign_name(SectionReader& section, const std::string& fallback) {
  std::string name = section.text("name", fallback);
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  });
  if (section.node().find("name") && (!plain || name.starts_with("."))) {
    section.errors().add(section.node().find("name")->place(),
                         "a campaign's name is letters, digits, '_', '-' and '.', and does not "
                         "begin with '.'");
  }
  return name;
}

void read_version(SectionReader& section) {
  const auto version = section.require("seedframe");
  if (!version) return;
  const long long value = read_integer(*version, 1, 1'000'000, section.errors());
  if (value > kConfigVersion) {
    section.errors().add(version->place(),
                         fmt::format("this config is of version {}; this program reads version {}",
                                     value, kConfigVersion));
  }
}

}  // namespace

Result<CampaignConfig> read_campaign_config(const std::string& text,
                                            const std::filesystem::path& file,
                                            const std::vector<Override>& overrides) {
  const Result<ConfigNode> root = ConfigNode::parse(text, file.string(), overrides);
  if (!root) return forward_error(root);
  const std::filesystem::path folder = file.parent_path();
  Diagnostics errors;
  CampaignConfig config;
  SectionReader section(*root, errors);
  read_version(section);
  config.name = read_campaign_name(section, file.stem().string());
  section.text("description", "");
  read_size(section, config);
  read_categories(section, config);
  config.asset_folders = read_folders(section, "asset_folders", folder);
  config.material_folders = read_folders(section, "material_folders", folder);
  config.render = read_render(section, errors);
  config.image = read_image(section, folder, errors);
  config.labels = read_labels(section, errors);
  if (const auto node = section.find("variables")) {
    SectionReader variables(*node, errors);
    config.campaign_variables = variables.variables("campaign");
    config.scene_variables = variables.variables("scene");
    config.frame_variables = variables.variables("frame");
    variables.refuse_other_keys();
  }
  config.materials = read_materials(section);
  config.objects = read_objects(section);
  config.lights = read_lights(section);
  if (const auto ground = section.find("ground")) config.ground = read_ground(*ground, errors);
  config.world = read_world(section);
  config.constraints = read_constraints(section, config.objects);
  config.max_attempts = static_cast<int>(section.integer("max_attempts", 100, 1, 100'000));
  read_graphs(section, config, folder);
  if (const auto camera = section.require("camera")) config.camera = read_camera(*camera, errors);
  section.refuse_other_keys();
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  return config;
}

Result<std::vector<MaterialConfig>> read_material_library(const std::string& text,
                                                          const std::filesystem::path& file) {
  const Result<ConfigNode> root = ConfigNode::parse(text, file.string());
  if (!root) return forward_error(root);
  Diagnostics errors;
  SectionReader section(*root, errors);
  std::vector<MaterialConfig> materials = read_materials(section);
  section.refuse_other_keys();
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  return materials;
}

}  // namespace seedframe
