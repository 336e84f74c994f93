#include "config/scene_sections.h"

#include <algorithm>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

LightType read_light_type(SectionReader& section) {
  static const std::vector<std::string> names = {"point", "sun", "spot", "area"};
  const std::string text = section.text("type", "point");
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) return static_cast<LightType>(found - names.begin());
  section.errors().add(section.node().find("type")->place(),
                       "unknown type of light" + did_you_mean(text, names));
  return LightType::kPoint;
}

/// Exactly one of power, lumens (lux for a sun).
void read_light_output(SectionReader& section, LightConfig& light) {
  const bool sun = light.type == LightType::kSun;
  light.power = section.optional_number("power");
  std::optional<NumberSource>& photometric = sun ? light.lux : light.lumens;
  const char* const key = sun ? "lux" : "lumens";
  photometric = section.optional_number(key);
  if (light.power && photometric) {
    section.errors().add(section.node().place(),
                         fmt::format("power and {} exclude each other", key));
  }
  if (!light.power && !photometric) {
    section.errors().add(section.node().place(),
                         fmt::format("the key 'power' or '{}' is missing", key));
    light.power = number_constant(0.0);
  }
}

LightConfig read_light(const std::string& name, const ConfigNode& node, Diagnostics& errors) {
  LightConfig light;
  light.name = name;
  light.place = node.place();
  SectionReader section(node, errors);
  light.type = read_light_type(section);
  light.variables = section.variables("variables");
  light.redraw = section.redraw(Level::kScene);
  light.grid = section.grid();
  light.count = section.number("count", 1.0);
  if (light.grid && node.find("count")) {
    errors.add(node.find("count")->place(), "count and grid exclude each other");
  }
  light.position = section.vector("position", {0, 0, 1});
  // Lamps in rows shine straight down by themselves, a single one at the origin.
  light.target_below = light.grid && !node.find("target");
  light.target = section.vector("target", {0, 0, 0});
  light.color = section.color("color", {1, 1, 1});
  read_light_output(section, light);
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

void read_lens(SectionReader& section, CameraConfig& camera) {
  Diagnostics& errors = section.errors();
  camera.fov_deg = section.optional_number("fov_deg");
  if (const auto focal = section.find("focal_px")) {
    for (const ConfigNode& item : focal->items()) {
      camera.focal_px.push_back(read_number(item, errors));
    }
    if (!focal->is_list()) camera.focal_px = {read_number(*focal, errors)};
    if (focal->is_list() && camera.focal_px.size() != 2) {
      errors.add(focal->place(),
                 "expected a focal length or [fx, fy], found " + focal->description());
    }
  }
  if (camera.fov_deg && !camera.focal_px.empty()) {
    errors.add(section.node().place(), "fov_deg and focal_px exclude each other");
  }
  if (!camera.fov_deg && camera.focal_px.empty()) camera.fov_deg = number_constant(50.0);
  if (const auto center = section.find("center_px")) {
    const auto items = center->items();
    if (items.size() == 2) {
      camera.center_px = {{read_number(items[0], errors), read_number(items[1], errors)}};
    } else {
      errors.add(center->place(), "expected [cx, cy], found " + center->description());
    }
  }
  camera.clip_start_m = section.number("clip_start_m", 0.01);
  camera.clip_end_m = section.number("clip_end_m", 1000.0);
  camera.f_stop = section.number("f_stop", 0.0);
  camera.sensor_width_mm = section.number("sensor_width_mm", 36.0);
  camera.focus_distance_m = section.optional_number("focus_distance_m");
}

}  // namespace

std::vector<LightConfig> read_lights(SectionReader& campaign) {
  return read_named(campaign, "lights", read_light);
}

GroundConfig read_ground(const ConfigNode& node, Diagnostics& errors) {
  GroundConfig ground;
  ground.place = node.place();
  SectionReader section(node, errors);
  ground.redraw = section.redraw(Level::kScene);
  ground.width_m = section.number("width_m", 10.0);
  ground.depth_m = section.number("depth_m", 10.0);
  ground.curvature_per_m = section.number("curvature_per_m", 0.0);
  ground.material = section.material("material");
  section.refuse_other_keys();
  return ground;
}

WorldConfig read_world(SectionReader& campaign) {
  WorldConfig world;
  const auto node = campaign.find("world");
  if (!node) {
    for (NumberSource& c : world.color.components) c = number_constant(1.0);
    world.strength = number_constant(0.1);
    return world;
  }
  SectionReader section(*node, campaign.errors());
  world.place = node->place();
  world.redraw = section.redraw(Level::kScene);
  world.color = section.color("color", {1, 1, 1});
  world.strength = section.number("strength", node->find("hdri") ? 1.0 : 0.1);
  if (const auto hdri = section.find("hdri")) world.hdri = read_name(*hdri, campaign.errors());
  world.rotation_deg = section.number("rotation_deg", 0.0);
  world.importance_map_px =
      static_cast<int>(section.integer("importance_map_px", world.importance_map_px, 4, 8192));
  section.refuse_other_keys();
  return world;
}

CameraConfig read_camera(const ConfigNode& node, Diagnostics& errors) {
  CameraConfig camera;
  camera.place = node.place();
  SectionReader section(node, errors);
  camera.redraw = section.redraw(Level::kFrame);
  camera.variables = section.variables("variables");
  read_lens(section, camera);
  if (section.find("parent")) camera.parent = section.text("parent", "");
  const auto target = section.find("target");
  if (target && !(target->is_scalar() && target->text() == "objects")) {
    camera.target = read_vector(*target, errors);
  }
  if (camera.parent && !camera.target) {
    errors.add(node.place(), "a camera with a parent needs a target, relative to the parent");
    camera.target = VectorSource{};
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
  section.refuse_other_keys();
  return camera;
}

SensorConfig read_sensor(const ConfigNode& node, Diagnostics& errors) {
  SensorConfig sensor;
  sensor.place = node.place();
  SectionReader section(node, errors);
  sensor.redraw = section.redraw(Level::kFrame);
  sensor.blur_px = section.number("blur_px", 0.0);
  sensor.exposure_stops = section.number("exposure_stops", 0.0);
  sensor.full_well = section.number("full_well", 0.0);
  sensor.read_noise = section.number("read_noise", 0.0);
  sensor.white_balance = section.color("white_balance", {1, 1, 1});
  sensor.jpeg_quality = section.number("jpeg_quality", 0.0);
  section.refuse_other_keys();
  return sensor;
}

}  // namespace seedframe
