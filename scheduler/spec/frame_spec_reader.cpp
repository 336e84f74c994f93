#include "spec/frame_spec_reader.h"

#include <algorithm>

#include <fmt/format.h>

namespace seedframe {
namespace {

Affine matrix_from_json(const Json& numbers) {
  Affine transform;
  std::size_t next = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      transform(row, column) = numbers.at(next++).get<double>();
    }
  }
  return transform;
}

/// The value of an enum whose names these are, in its order.
template <class Enum, class Names>
Enum named(const Json& json, const Names& names, const char* what) {
  const auto name = json.get<std::string>();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw Json::other_error::create(501, fmt::format("unknown {} '{}'", what, name), nullptr);
  }
  return static_cast<Enum>(found - names.begin());
}

RenderLevers levers_from_json(const Json& json) {
  RenderLevers levers;
  const Json bounces = json.value("bounces", Json::object());
  for (const auto& [limit, kind] :
       {std::pair(&levers.bounces.diffuse, "diffuse"), std::pair(&levers.bounces.glossy, "glossy"),
        std::pair(&levers.bounces.transmission, "transmission"),
        std::pair(&levers.bounces.transparent, "transparent")}) {
    if (bounces.contains(kind)) *limit = integer_of<int>(bounces.at(kind));
  }
  levers.light_threshold = json.value("light_threshold", 0.0);
  levers.clamp_direct = json.value("clamp_direct", 0.0);
  levers.filter_glossy = json.value("filter_glossy", 0.0);
  levers.path_guiding = json.value("path_guiding", false);
  if (json.contains("texture_limit_px")) {
    levers.texture_limit_px = integer_of<int>(json.at("texture_limit_px"));
  }
  return levers;
}

PixelRect region_from_json(const Json& numbers) {
  return {integer_of<int>(numbers.at(0)), integer_of<int>(numbers.at(1)),
          integer_of<int>(numbers.at(2)), integer_of<int>(numbers.at(3))};
}

RenderSettings render_from_json(const Json& json) {
  RenderSettings render;
  render.width = integer_of<int>(json.at("width"));
  render.height = integer_of<int>(json.at("height"));
  render.samples = integer_of<int>(json.at("samples"));
  if (json.contains("adaptive")) {
    json.at("adaptive").at("threshold").get_to(render.adaptive.threshold);
    render.adaptive.min_samples = integer_of<int>(json.at("adaptive").at("min_samples"));
  }
  render.denoise = named<Denoise>(json.at("denoise"), kDenoiseNames, "denoiser");
  render.seed = integer_of<std::uint32_t>(json.at("seed"));
  render.max_bounces = integer_of<int>(json.at("max_bounces"));
  json.at("filter_width_px").get_to(render.filter_width_px);
  json.at("clamp_indirect").get_to(render.clamp_indirect);
  json.at("depth").get_to(render.depth);
  json.at("normal").get_to(render.normal);
  if (json.contains("levers")) render.levers = levers_from_json(json.at("levers"));
  if (json.contains("region")) render.region = region_from_json(json.at("region"));
  return render;
}

LightSpec light_from_json(const Json& json) {
  LightSpec light;
  light.kind = named<LightKind>(json.at("kind"), kLightKindNames, "kind of light");
  light.camera_from_light = matrix_from_json(json.at("camera_from_light"));
  json.at("color").get_to(light.color);
  json.at("power").get_to(light.power);
  light.radius_m = json.value("radius_m", 0.0);
  light.angle_rad = json.value("angle_rad", 0.0);
  light.blend = json.value("blend", 0.0);
  light.width_m = json.value("width_m", 0.0);
  light.height_m = json.value("height_m", 0.0);
  return light;
}

MaterialSpec material_from_json(const Json& json) {
  MaterialSpec material;
  json.at("base_color").get_to(material.base_color);
  json.at("metallic").get_to(material.metallic);
  json.at("roughness").get_to(material.roughness);
  json.at("specular").get_to(material.specular);
  json.at("transmission").get_to(material.transmission);
  json.at("ior").get_to(material.ior);
  json.at("clearcoat").get_to(material.clearcoat);
  json.at("texture_repeat").get_to(material.texture_repeat);
  json.at("textures").get_to(material.textures);
  return material;
}

InstanceSpec instance_from_json(const Json& json) {
  InstanceSpec instance;
  json.at("name").get_to(instance.name);
  instance.id = integer_of<int>(json.at("id"));
  instance.category = integer_of<int>(json.at("category"));
  json.at("mesh").get_to(instance.mesh);
  instance.asset = json.value("asset", std::string());
  for (const Json& item : json.value("keypoints", Json::array())) {
    const auto at = item.at("point_m").get<std::array<double, 3>>();
    instance.keypoints.push_back(
        {item.at("name").get<std::string>(), {at[0], at[1], at[2]}, item.at("inside").get<bool>()});
  }
  for (const Json& index : json.at("materials").get<std::vector<Json>>()) {
    instance.materials.push_back(integer_of<int>(index));
  }
  instance.camera_from_object = matrix_from_json(json.at("camera_from_object"));
  for (const Json& kind : json.at("hidden_from")) {
    const auto name = kind.get<std::string>();
    if (name == "camera") instance.hidden_from.camera = true;
    if (name == "diffuse") instance.hidden_from.diffuse = true;
    if (name == "glossy") instance.hidden_from.glossy = true;
    if (name == "shadow") instance.hidden_from.shadow = true;
    if (name == "transmission") instance.hidden_from.transmission = true;
  }
  return instance;
}

SensorSettings sensor_from_json(const Json& json) {
  SensorSettings sensor;
  json.at("blur_px").get_to(sensor.blur_px);
  json.at("exposure_stops").get_to(sensor.exposure_stops);
  json.at("full_well").get_to(sensor.full_well);
  sensor.jpeg_quality = integer_of<int>(json.at("jpeg_quality"));
  json.at("read_noise").get_to(sensor.read_noise);
  sensor.seed = integer_of<std::uint32_t>(json.at("seed"));
  json.at("white_balance").get_to(sensor.white_balance);
  return sensor;
}

FrameSpec read(const Json& json) {
  FrameSpec spec;
  spec.render = render_from_json(json.at("render"));
  const Json& camera = json.at("camera");
  camera.at("focal_px").get_to(spec.camera.focal_px);
  camera.at("center_px").get_to(spec.camera.center_px);
  camera.at("clip_start_m").get_to(spec.camera.clip_start_m);
  camera.at("clip_end_m").get_to(spec.camera.clip_end_m);
  camera.at("aperture_radius_m").get_to(spec.camera.aperture_radius_m);
  camera.at("focus_distance_m").get_to(spec.camera.focus_distance_m);
  const Json& world = json.at("world");
  world.at("color").get_to(spec.world.color);
  world.at("strength").get_to(spec.world.strength);
  spec.world.hdri = world.value("hdri", std::string());
  if (!spec.world.hdri.empty()) {
    spec.world.importance_map_px = integer_of<int>(world.at("importance_map_px"));
    const Json& numbers = world.at("map_from_camera");
    for (std::size_t i = 0; i < 9; ++i) {
      spec.world.map_from_camera(static_cast<int>(i / 3), static_cast<int>(i % 3)) =
          numbers.at(i).get<double>();
    }
  }
  for (const Json& item : json.at("materials")) spec.materials.push_back(material_from_json(item));
  for (const Json& item : json.at("instances")) spec.instances.push_back(instance_from_json(item));
  for (const Json& item : json.at("lights")) spec.lights.push_back(light_from_json(item));
  const Json& image = json.at("image");
  image.at("display").get_to(spec.image.display);
  image.at("view").get_to(spec.image.view);
  image.at("look").get_to(spec.image.look);
  image.at("exposure_stops").get_to(spec.image.exposure_stops);
  image.at("gamma").get_to(spec.image.gamma);
  if (json.contains("sensor")) spec.sensor = sensor_from_json(json.at("sensor"));
  const Json& labels = json.at("labels");
  labels.at("twin_exact").get_to(spec.labels.twin_exact);
  if (labels.contains("target")) spec.labels.target = integer_of<int>(labels.at("target"));
  if (labels.at("source").get<std::string>() == "geometry") {
    spec.labels.source = LabelSource::kTwin;
  }
  return spec;
}

}  // namespace

Result<FrameSpec> frame_spec_from_json(const Json& json, const std::string& what) {
  const Result<int> version = json_field<int>(json, "version", what);
  if (!version) return forward_error(version);
  if (*version < kOldestFrameSpecVersion || *version > kFrameSpecVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} is a frame spec of version {}; this program reads versions {} to {}", what,
                *version, kOldestFrameSpecVersion, kFrameSpecVersion);
  }
  try {
    return read(json);
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{} is not a frame spec: {}", what, error.what());
  }
}

}  // namespace seedframe
