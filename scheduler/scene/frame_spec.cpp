#include "scene/frame_spec.h"

#include <algorithm>

#include "base/sha256.h"

namespace seedframe {
namespace {

constexpr int kVersion = 1;
constexpr std::array<const char*, 4> kLightKinds = {"point", "sun", "spot", "area"};

Json matrix_json(const Affine& transform) {
  Json numbers = Json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(transform(row, column));
  }
  return numbers;
}

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

LightKind light_kind(const std::string& name) {
  const auto found = std::find(kLightKinds.begin(), kLightKinds.end(), name);
  if (found == kLightKinds.end()) {
    throw Json::other_error::create(501, "unknown kind of light '" + name + "'", nullptr);
  }
  return static_cast<LightKind>(found - kLightKinds.begin());
}

Json light_json(const LightSpec& light) {
  Json json = {{"kind", kLightKinds[static_cast<std::size_t>(light.kind)]},
               {"camera_from_light", matrix_json(light.camera_from_light)},
               {"color", light.color},
               {"power", light.power}};
  switch (light.kind) {
    case LightKind::kSpot:
      json["blend"] = light.blend;
      json["angle_rad"] = light.angle_rad;
      [[fallthrough]];
    case LightKind::kPoint:
      json["radius_m"] = light.radius_m;
      break;
    case LightKind::kSun:
      json["angle_rad"] = light.angle_rad;
      break;
    case LightKind::kArea:
      json["width_m"] = light.width_m;
      json["height_m"] = light.height_m;
      break;
  }
  return json;
}

LightSpec light_from_json(const Json& json) {
  LightSpec light;
  light.kind = light_kind(json.at("kind").get<std::string>());
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

Json material_json(const MaterialSpec& material) {
  return {{"base_color", material.base_color},     {"metallic", material.metallic},
          {"roughness", material.roughness},       {"specular", material.specular},
          {"transmission", material.transmission}, {"ior", material.ior},
          {"clearcoat", material.clearcoat},       {"texture_repeat", material.texture_repeat},
          {"textures", material.textures}};
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

Json instance_json(const InstanceSpec& instance) {
  return {{"name", instance.name},
          {"id", instance.id},
          {"category", instance.category},
          {"mesh", instance.mesh},
          {"materials", instance.materials},
          {"camera_from_object", matrix_json(instance.camera_from_object)}};
}

InstanceSpec instance_from_json(const Json& json) {
  InstanceSpec instance;
  json.at("name").get_to(instance.name);
  json.at("id").get_to(instance.id);
  json.at("category").get_to(instance.category);
  json.at("mesh").get_to(instance.mesh);
  json.at("materials").get_to(instance.materials);
  instance.camera_from_object = matrix_from_json(json.at("camera_from_object"));
  return instance;
}

FrameSpec read(const Json& json) {
  FrameSpec spec;
  const Json& render = json.at("render");
  render.at("width").get_to(spec.render.width);
  render.at("height").get_to(spec.render.height);
  render.at("samples").get_to(spec.render.samples);
  render.at("seed").get_to(spec.render.seed);
  render.at("max_bounces").get_to(spec.render.max_bounces);
  render.at("filter_width_px").get_to(spec.render.filter_width_px);
  render.at("clamp_indirect").get_to(spec.render.clamp_indirect);
  render.at("depth").get_to(spec.render.depth);
  render.at("normal").get_to(spec.render.normal);
  const Json& camera = json.at("camera");
  camera.at("focal_px").get_to(spec.camera.focal_px);
  camera.at("clip_start_m").get_to(spec.camera.clip_start_m);
  camera.at("clip_end_m").get_to(spec.camera.clip_end_m);
  json.at("world").at("color").get_to(spec.world.color);
  json.at("world").at("strength").get_to(spec.world.strength);
  for (const Json& item : json.at("materials")) spec.materials.push_back(material_from_json(item));
  for (const Json& item : json.at("instances")) spec.instances.push_back(instance_from_json(item));
  for (const Json& item : json.at("lights")) spec.lights.push_back(light_from_json(item));
  const Json& image = json.at("image");
  image.at("display").get_to(spec.image.display);
  image.at("view").get_to(spec.image.view);
  image.at("look").get_to(spec.image.look);
  image.at("exposure_stops").get_to(spec.image.exposure_stops);
  image.at("gamma").get_to(spec.image.gamma);
  return spec;
}

template <class T, class F>
Json array_of(const std::vector<T>& items, F to_item) {
  Json array = Json::array();
  for (const T& item : items) array.push_back(to_item(item));
  return array;
}

}  // namespace

Json to_json(const FrameSpec& spec) {
  return {{"version", kVersion},
          {"render",
           {{"width", spec.render.width},
            {"height", spec.render.height},
            {"samples", spec.render.samples},
            {"seed", spec.render.seed},
            {"max_bounces", spec.render.max_bounces},
            {"filter_width_px", spec.render.filter_width_px},
            {"clamp_indirect", spec.render.clamp_indirect},
            {"depth", spec.render.depth},
            {"normal", spec.render.normal}}},
          {"camera",
           {{"focal_px", spec.camera.focal_px},
            {"clip_start_m", spec.camera.clip_start_m},
            {"clip_end_m", spec.camera.clip_end_m}}},
          {"world", {{"color", spec.world.color}, {"strength", spec.world.strength}}},
          {"materials", array_of(spec.materials, material_json)},
          {"instances", array_of(spec.instances, instance_json)},
          {"lights", array_of(spec.lights, light_json)},
          {"image",
           {{"display", spec.image.display},
            {"view", spec.image.view},
            {"look", spec.image.look},
            {"exposure_stops", spec.image.exposure_stops},
            {"gamma", spec.image.gamma}}}};
}

Result<FrameSpec> frame_spec_from_json(const Json& json, const std::string& what) {
  const Result<int> version = json_field<int>(json, "version", what);
  if (!version) return forward_error(version);
  if (*version != kVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} is a frame spec of version {}; this program reads version {}", what, *version,
                kVersion);
  }
  try {
    return read(json);
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{} is not a frame spec: {}", what, error.what());
  }
}

std::string frame_id(const FrameSpec& spec) { return sha256_hex(canonical_json(to_json(spec))); }

}  // namespace seedframe
