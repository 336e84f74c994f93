#include "config/campaign_config.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <set>

#include "base/nearest_name.h"
#include "config/section_reader.h"

namespace seedframe {
namespace {

constexpr int kConfigVersion = 1;
constexpr long long kLargestSide = 16384;       // of an image, pixels
constexpr long long kMostFrames = 100'000'000;  // of a campaign

MaterialConfig read_material(const std::string& name, const ConfigNode& node, Diagnostics& errors) {
  MaterialConfig material;
  material.name = name;
  material.place = node.place();
  SectionReader section(node, errors);
  material.base_color = section.color("base_color", {0.8, 0.8, 0.8});
  if (const auto textures = section.find("textures")) {
    material.textures = read_name(*textures, errors);
    if (!node.find("base_color")) {
      for (NumberSource& c : material.base_color.components) c = number_constant(1.0);
    }
  }
  material.metallic = section.number("metallic", 0.0);
  material.roughness = section.number("roughness", 0.5);
  material.specular = section.number("specular", 0.5);
  material.transmission = section.number("transmission", 0.0);
  material.ior = section.number("ior", 1.45);
  material.clearcoat = section.number("clearcoat", 0.0);
  material.texture_repeat = section.number("texture_repeat", 1.0);
  section.refuse_other_keys();
  return material;
}

std::vector<MaterialConfig> read_materials(SectionReader& section) {
  std::vector<MaterialConfig> materials;
  const auto node = section.find("materials");
  if (!node) return materials;
  for (const auto& [name, body] : node->entries()) {
    materials.push_back(read_material(name, body, section.errors()));
  }
  return materials;
}

ScatterConfig read_scatter(const ConfigNode& node, Diagnostics& errors) {
  ScatterConfig scatter;
  scatter.place = node.place();
  SectionReader section(node, errors);
  const auto range = [&](const char* key, std::array<NumberSource, 2>& ends) {
    const auto found = section.require(key);
    if (!found) return;
    const auto items = found->items();
    if (items.size() != 2) {
      errors.add(found->place(), "expected [least, most], found " + found->description());
      return;
    }
    for (std::size_t i = 0; i < 2; ++i) ends[i] = read_number(items[i], errors);
  };
  range("x", scatter.x);
  range("y", scatter.y);
  scatter.gap_m = section.number("gap_m", 0.0);
  section.refuse_other_keys();
  return scatter;
}

ObjectConfig read_object(const std::string& name, const ConfigNode& node, Diagnostics& errors) {
  ObjectConfig object;
  object.name = name;
  object.place = node.place();
  SectionReader section(node, errors);
  object.variables = section.variables("variables");
  object.redraw = section.redraw(Level::kScene);
  object.count = section.number("count", 1.0);
  if (const auto asset = section.require("asset")) object.asset = read_name(*asset, errors);
  if (const auto category = section.find("category")) {
    object.category = read_name(*category, errors);
  }
  object.material = {node.place(), {{"default", number_constant(1.0)}}};
  if (const auto material = section.find("material")) {
    object.material = read_name(*material, errors);
  }
  object.scale = section.number("scale", 1.0);
  object.rotation_deg = section.vector("rotation_deg", {0, 0, 0});
  object.position = section.vector("position", {0, 0, 0});
  if (const auto scatter = section.find("scatter")) {
    object.scatter = read_scatter(*scatter, errors);
  }
  object.rest_on_ground = section.flag("rest_on_ground", false);
  section.refuse_other_keys();
  return object;
}

LightType read_light_type(SectionReader& section) {
  static const std::vector<std::string> names = {"point", "sun", "spot", "area"};
  const std::string text = section.text("type", "point");
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) return static_cast<LightType>(found - names.begin());
  section.errors().add(section.node().find("type")->place(),
                       "unknown type of light" + did_you_mean(text, names));
  return LightType::kPoint;
}

LightConfig read_light(const std::string& name, const ConfigNode& node, Diagnostics& errors) {
  LightConfig light;
  light.name = name;
  light.place = node.place();
  SectionReader section(node, errors);
  light.type = read_light_type(section);
  light.variables = section.variables("variables");
  light.redraw = section.redraw(Level::kScene);
  light.count = section.number("count", 1.0);
  light.position = section.vector("position", {0, 0, 1});
  light.target = section.vector("target", {0, 0, 0});
  light.color = section.color("color", {1, 1, 1});
  if (const auto power = section.require("power")) light.power = read_number(*power, errors);
  const bool has_radius = light.type == LightType::kPoint || light.type == LightType::kSpot;
  const bool has_angle = light.type == LightType::kSun || light.type == LightType::kSpot;
  if (has_radius) light.radius_m = section.number("radius_m", 0.05);
  if (has_angle)
    light.angle_deg = section.number("angle_deg", light.type == LightType::kSun ? 0.526 : 45.0);
  if (light.type == LightType::kSpot) light.blend = section.number("blend", 0.15);
  if (light.type == LightType::kArea) {
    light.width_m = section.number("width_m", 1.0);
    light.height_m = section.number("height_m", 1.0);
  }
  section.refuse_other_keys();
  return light;
}

GroundConfig read_ground(const ConfigNode& node, Diagnostics& errors) {
  GroundConfig ground;
  ground.place = node.place();
  SectionReader section(node, errors);
  ground.redraw = section.redraw(Level::kScene);
  ground.width_m = section.number("width_m", 10.0);
  ground.depth_m = section.number("depth_m", 10.0);
  ground.material = {node.place(), {{"default", number_constant(1.0)}}};
  if (const auto material = section.find("material")) {
    ground.material = read_name(*material, errors);
  }
  section.refuse_other_keys();
  return ground;
}

WorldConfig read_world(SectionReader& campaign, Diagnostics& errors) {
  WorldConfig world;
  const auto node = campaign.find("world");
  if (!node) {
    for (NumberSource& c : world.color.components) c = number_constant(1.0);
    world.strength = number_constant(0.1);
    return world;
  }
  SectionReader section(*node, errors);
  world.redraw = section.redraw(Level::kScene);
  world.color = section.color("color", {1, 1, 1});
  world.strength = section.number("strength", 0.1);
  section.refuse_other_keys();
  return world;
}

CameraConfig read_camera(const ConfigNode& node, Diagnostics& errors) {
  CameraConfig camera;
  camera.place = node.place();
  SectionReader section(node, errors);
  camera.redraw = section.redraw(Level::kFrame);
  camera.variables = section.variables("variables");
  if (const auto fov = section.find("fov_deg")) camera.fov_deg = read_number(*fov, errors);
  if (const auto focal = section.find("focal_px")) camera.focal_px = read_number(*focal, errors);
  if (camera.fov_deg && camera.focal_px) {
    errors.add(node.place(), "fov_deg and focal_px exclude each other");
  }
  if (!camera.fov_deg && !camera.focal_px) camera.fov_deg = number_constant(50.0);
  const auto target = section.find("target");
  if (target && !(target->is_scalar() && target->text() == "objects")) {
    camera.target = read_vector(*target, errors);
  }
  const auto distance = section.find("distance_m");
  if (const auto position = section.find("position")) {
    camera.position = read_vector(*position, errors);
    if (distance) errors.add(distance->place(), "distance_m and position exclude each other");
  } else if (distance) {
    camera.distance_m = read_number(*distance, errors);
  } else {
    errors.add(node.place(), "a camera needs a position, or a distance_m from its target");
  }
  camera.azimuth_deg = section.number("azimuth_deg", 0.0);
  camera.elevation_deg = section.number("elevation_deg", 45.0);
  camera.roll_deg = section.number("roll_deg", 0.0);
  camera.clip_start_m = section.number("clip_start_m", 0.01);
  camera.clip_end_m = section.number("clip_end_m", 1000.0);
  section.refuse_other_keys();
  return camera;
}

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

template <class T>
std::vector<T> read_named(SectionReader& section, const char* key,
                          T (*read)(const std::string&, const ConfigNode&, Diagnostics&)) {
  std::vector<T> list;
  const auto node = section.find(key);
  if (!node) return list;
  if (!node->is_map() && !node->is_null()) {
    section.errors().add(node->place(),
                         "expected a mapping of names, found " + node->description());
  }
  for (const auto& [name, body] : node->entries()) {
    if (!is_identifier(name)) {
      section.errors().add(body.place(),
                           "a name must be letters, digits and '_', and not start "
                           "with a digit");
    }
    list.push_back(read(name, body, section.errors()));
  }
  return list;
}

void read_size(SectionReader& section, CampaignConfig& config) {
  config.seed = static_cast<std::uint64_t>(
      section.integer("seed", 0, 0, std::numeric_limits<long long>::max()));
  config.scenes = section.integer("scenes", 1, 1, kMostFrames);
  config.frames_per_scene = section.integer("frames_per_scene", 1, 1, kMostFrames);
  if (config.frame_count() > kMostFrames) {
    section.errors().add(section.node().place(),
                         fmt::format("scenes × frames_per_scene must not exceed {}", kMostFrames));
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
  if (const auto node = section.find("variables")) {
    SectionReader variables(*node, errors);
    config.campaign_variables = variables.variables("campaign");
    config.scene_variables = variables.variables("scene");
    config.frame_variables = variables.variables("frame");
    variables.refuse_other_keys();
  }
  config.materials = read_materials(section);
  config.objects = read_named(section, "objects", read_object);
  config.lights = read_named(section, "lights", read_light);
  if (const auto ground = section.find("ground")) config.ground = read_ground(*ground, errors);
  config.world = read_world(section, errors);
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
