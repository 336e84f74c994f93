#include "config/campaign_config.h"

#include <algorithm>
#include <limits>
#include <set>

#include "base/message_text.h"
#include "base/nearest_name.h"
#include "base/philox.h"
#include "config/determinism_section.h"
#include "config/image_section.h"
#include "config/plan_sections.h"
#include "config/quality_section.h"
#include "config/render_section.h"
#include "config/scene_sections.h"
#include "config/section_reader.h"

namespace seedframe {
namespace {

constexpr int kConfigVersion = 1;

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
  TwinTolerance& tolerance = labels.check.tolerance;
  labels.check.wanted = section.flag("check", labels.check.wanted);
  tolerance.inside_share = read_share(section, "tolerance", tolerance.inside_share);
  tolerance.outline_share = read_share(section, "edge_tolerance", tolerance.outline_share);
  section.refuse_other_keys();
  return labels;
}

std::vector<std::filesystem::path> read_folders(SectionReader& section, const std::string& key) {
  std::vector<std::filesystem::path> folders;
  const auto list = section.find(key);
  if (!list) return folders;
  if (!list->is_list()) {
    section.errors().add(list->place(), "expected a list of folders, found " + list->description());
  }
  for (const ConfigNode& item : list->items()) {
    const auto folder = item.named_path(section.errors());
    if (!folder) continue;
    folders.push_back(*folder);
    std::error_code missing;
    if (std::filesystem::is_directory(*folder, missing)) continue;
    section.errors().add(item.place(), "there is no folder '" + item.text() +
                                           "' (paths start at the config's folder)");
  }
  return folders;
}

void read_size(SectionReader& section, CampaignConfig& config) {
  config.seed = static_cast<std::uint64_t>(
      section.integer("seed", 0, 0, std::numeric_limits<long long>::max()));
  config.stream = section.text("stream", "");
  if (!config.stream.empty() && !is_one_line_name(config.stream)) {
    section.errors().add(section.node().find("stream")->place(),
                         "the name of a stream is one line of at most 200 bytes, without control "
                         "characters, found '" +
                             shortened(config.stream, 200) + "'");
  }
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

void read_graphs(SectionReader& section, CampaignConfig& config) {
  const auto node = section.find("graphs");
  if (!node) return;
  config.graphs = node->named_path(section.errors());
  std::error_code missing;
  if (config.graphs && !std::filesystem::is_regular_file(*config.graphs, missing)) {
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
    if (!is_one_line_name(category)) {
      section.errors().add(section.node().find("categories")->place(),
                           "a category's name is one line of at most 200 bytes, without control "
                           "characters, found '" +
                               shortened(category, 200) + "'");
    }
    if (!seen.insert(category).second) {
      section.errors().add(section.node().find("categories")->place(),
                           "the category '" + category + "' is listed twice");
    }
  }
  constexpr std::size_t kMostCategories = 255;  // semantic.png has 8 bits
  if (config.categories.size() > kMostCategories) {
    section.errors().add(section.node().find("categories")->place(),
                         fmt::format("at most {} categories", kMostCategories));
  }
}

constexpr std::size_t kLongestName = 100;  // of a campaign; it becomes the name of a folder

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.';
}

bool may_begin_name(char c) { return c != '.' && c != '-'; }

/// The name of the file, made to fit the rules: like the config, it may come from anybody.
std::string default_campaign_name(const std::filesystem::path& file) {
  std::string name = file.stem().string().substr(0, kLongestName);
  if (name.empty()) return "campaign";
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_name_character(c); }, '_');
  if (!may_begin_name(name.front())) name.front() = '_';
  return name;
}

std::string read_campaign_name(SectionReader& section, const std::filesystem::path& file) {
  std::string name = section.text("name", default_campaign_name(file));
  const bool plain = name.size() <= kLongestName && may_begin_name(name.front()) &&
                     std::all_of(name.begin(), name.end(), is_name_character);
  if (!plain) {
    section.errors().add(section.node().find("name")->place(),
                         "a campaign's name is letters, digits, '_', '-' and '.', at most 100 of "
                         "them, and does not begin with '.' or '-'");
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
                                            const std::vector<Override>& overrides,
                                            const AllowedFolders& allowed) {
  const Result<ConfigNode> root = ConfigNode::parse(text, file.string(), overrides, allowed);
  if (!root) return forward_error(root);
  Diagnostics errors;
  CampaignConfig config;
  SectionReader section(*root, errors);
  read_version(section);
  config.name = read_campaign_name(section, file);
  section.text("description", "");
  read_size(section, config);
  read_categories(section, config);
  config.asset_folders = read_folders(section, "asset_folders");
  config.material_folders = read_folders(section, "material_folders");
  config.render = read_render(section, errors);
  config.determinism = read_determinism(section, config.render);
  config.image = read_image(section, config.render);
  config.labels = read_labels(section, errors);
  config.quality = read_quality(section, config.render, config.labels);
  config.patches = read_patches(section, config.render);
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
  read_graphs(section, config);
  if (const auto camera = section.require("camera")) config.camera = read_camera(*camera, errors);
  if (const auto sensor = section.find("sensor")) config.sensor = read_sensor(*sensor, errors);
  section.refuse_other_keys();
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  config.files = root->named_files();
  return config;
}

std::uint64_t CampaignConfig::draw_seed() const {
  return stream.empty() ? seed : PhiloxStream(seed, "stream/" + stream).bits({});
}

Result<std::vector<MaterialConfig>> read_material_library(const std::string& text,
                                                          const std::filesystem::path& file,
                                                          const AllowedFolders& allowed) {
  const Result<ConfigNode> root = ConfigNode::parse(text, file.string(), {}, allowed);
  if (!root) return forward_error(root);
  Diagnostics errors;
  SectionReader section(*root, errors);
  std::vector<MaterialConfig> materials = read_materials(section);
  section.refuse_other_keys();
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  return materials;
}

}  // namespace seedframe
