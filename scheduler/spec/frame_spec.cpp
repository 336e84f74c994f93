#include "spec/frame_spec.h"

#include <algorithm>
#include <cmath>

#include "base/sha256.h"

namespace seedframe {
namespace {

constexpr std::array<const char*, 4> kLightKinds = {"point", "sun", "spot", "area"};

/// Appends canonical JSON; keys must come in byte order.
class Writer {
 public:
  explicit Writer(std::string& out) : out_(out) {}

  void open(char bracket) {
    out_ += bracket;
    first_ = true;
  }
  void close(char bracket) {
    out_ += bracket;
    first_ = false;
  }
  void key(std::string_view name) {
    separate();
    out_ += '"';
    out_ += name;
    out_ += "\":";
  }
  void item() { separate(); }

  void number(double value) { append_canonical(out_, value); }
  void text(std::string_view value) { append_canonical(out_, value); }

  void field(std::string_view name, double value) {
    key(name);
    number(value);
  }
  void field(std::string_view name, std::string_view value) {
    key(name);
    text(value);
  }
  void field(std::string_view name, bool value) {
    key(name);
    out_ += value ? "true" : "false";
  }
  template <class Numbers>
  void numbers(std::string_view name, const Numbers& values) {
    key(name);
    open('[');
    for (const auto& value : values) {
      item();
      number(static_cast<double>(value));
    }
    close(']');
  }
  template <class Matrix>
  void matrix(std::string_view name, const Matrix& values) {
    key(name);
    open('[');
    for (int row = 0; row < values.rows(); ++row) {
      for (int column = 0; column < values.cols(); ++column) {
        item();
        number(values(row, column));
      }
    }
    close(']');
  }
  template <class Items, class Write>
  void list(std::string_view name, const Items& items, Write write) {
    key(name);
    open('[');
    for (const auto& each : items) {
      item();
      open('{');
      write(*this, each);
      close('}');
    }
    close(']');
  }

 private:
  void separate() {
    if (!first_) out_ += ',';
    first_ = false;
  }

  std::string& out_;
  bool first_ = true;
};

void write_camera(Writer& out, const CameraSpec& camera) {
  out.field("aperture_radius_m", camera.aperture_radius_m);
  out.numbers("center_px", camera.center_px);
  out.field("clip_end_m", camera.clip_end_m);
  out.field("clip_start_m", camera.clip_start_m);
  out.numbers("focal_px", camera.focal_px);
  out.field("focus_distance_m", camera.focus_distance_m);
}

void write_image(Writer& out, const ImageSettings& image) {
  out.field("display", std::string_view(image.display));
  out.field("exposure_stops", image.exposure_stops);
  out.field("gamma", image.gamma);
  out.field("look", std::string_view(image.look));
  out.field("view", std::string_view(image.view));
}

void write_keypoint(Writer& out, const Keypoint& keypoint) {
  out.field("inside", keypoint.inside);
  out.field("name", std::string_view(keypoint.name));
  out.matrix("point_m", keypoint.point_m);
}

void write_instance(Writer& out, const InstanceSpec& instance) {
  if (!instance.asset.empty()) out.field("asset", std::string_view(instance.asset));
  out.matrix("camera_from_object", instance.camera_from_object.matrix());
  out.field("category", static_cast<double>(instance.category));
  out.key("hidden_from");
  out.open('[');
  const HiddenFrom& hidden = instance.hidden_from;
  for (const auto& [flag, name] :
       {std::pair(hidden.camera, "camera"), std::pair(hidden.diffuse, "diffuse"),
        std::pair(hidden.glossy, "glossy"), std::pair(hidden.shadow, "shadow"),
        std::pair(hidden.transmission, "transmission")}) {
    if (!flag) continue;
    out.item();
    out.text(name);
  }
  out.close(']');
  out.field("id", static_cast<double>(instance.id));
  if (!instance.keypoints.empty()) out.list("keypoints", instance.keypoints, write_keypoint);
  out.numbers("materials", instance.materials);
  out.field("mesh", std::string_view(instance.mesh));
  out.field("name", std::string_view(instance.name));
}

void write_labels(Writer& out, const LabelSettings& labels) {
  const bool twin = labels.source == LabelSource::kTwin;
  out.field("source", std::string_view(twin ? "geometry" : "render"));
  out.field("twin_exact", labels.twin_exact);
}

void write_light(Writer& out, const LightSpec& light) {
  const bool spot = light.kind == LightKind::kSpot;
  const bool area = light.kind == LightKind::kArea;
  if (spot || light.kind == LightKind::kSun) out.field("angle_rad", light.angle_rad);
  if (spot) out.field("blend", light.blend);
  out.matrix("camera_from_light", light.camera_from_light.matrix());
  out.numbers("color", light.color);
  if (area) out.field("height_m", light.height_m);
  out.field("kind", std::string_view(kLightKinds[static_cast<std::size_t>(light.kind)]));
  out.field("power", light.power);
  if (spot || light.kind == LightKind::kPoint) out.field("radius_m", light.radius_m);
  if (area) out.field("width_m", light.width_m);
}

void write_material(Writer& out, const MaterialSpec& material) {
  out.numbers("base_color", material.base_color);
  out.field("clearcoat", material.clearcoat);
  out.field("ior", material.ior);
  out.field("metallic", material.metallic);
  out.field("roughness", material.roughness);
  out.field("specular", material.specular);
  out.field("texture_repeat", material.texture_repeat);
  out.key("textures");
  out.open('{');
  for (const auto& [role, hash] : material.textures) out.field(role, std::string_view(hash));
  out.close('}');
  out.field("transmission", material.transmission);
}

void write_render(Writer& out, const RenderSettings& render) {
  out.field("clamp_indirect", render.clamp_indirect);
  out.field("depth", render.depth);
  out.field("filter_width_px", render.filter_width_px);
  out.field("height", static_cast<double>(render.height));
  out.field("max_bounces", static_cast<double>(render.max_bounces));
  out.field("normal", render.normal);
  out.field("samples", static_cast<double>(render.samples));
  out.field("seed", static_cast<double>(render.seed));
  out.field("width", static_cast<double>(render.width));
}

void write_world(Writer& out, const WorldSpec& world) {
  out.numbers("color", world.color);
  if (!world.hdri.empty()) {
    out.field("hdri", std::string_view(world.hdri));
    out.matrix("map_from_camera", world.map_from_camera);
  }
  out.field("strength", world.strength);
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

FrameSpec read(const Json& json) {
  FrameSpec spec;
  const Json& render = json.at("render");
  spec.render.width = integer_of<int>(render.at("width"));
  spec.render.height = integer_of<int>(render.at("height"));
  spec.render.samples = integer_of<int>(render.at("samples"));
  spec.render.seed = integer_of<std::uint32_t>(render.at("seed"));
  spec.render.max_bounces = integer_of<int>(render.at("max_bounces"));
  render.at("filter_width_px").get_to(spec.render.filter_width_px);
  render.at("clamp_indirect").get_to(spec.render.clamp_indirect);
  render.at("depth").get_to(spec.render.depth);
  render.at("normal").get_to(spec.render.normal);
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
  const Json& labels = json.at("labels");
  labels.at("twin_exact").get_to(spec.labels.twin_exact);
  if (labels.at("source").get<std::string>() == "geometry") {
    spec.labels.source = LabelSource::kTwin;
  }
  return spec;
}

}  // namespace

std::string canonical_text(const FrameSpec& spec) {
  constexpr std::size_t kBytesPerItem = 600;
  std::string text;
  text.reserve((4 + spec.instances.size() + spec.materials.size() + spec.lights.size()) *
               kBytesPerItem);
  Writer out(text);
  out.open('{');
  const auto object = [&](std::string_view name, auto write, const auto& value) {
    out.key(name);
    out.open('{');
    write(out, value);
    out.close('}');
  };
  object("camera", write_camera, spec.camera);
  object("image", write_image, spec.image);
  out.list("instances", spec.instances, write_instance);
  object("labels", write_labels, spec.labels);
  out.list("lights", spec.lights, write_light);
  out.list("materials", spec.materials, write_material);
  object("render", write_render, spec.render);
  out.field("version", static_cast<double>(kFrameSpecVersion));
  object("world", write_world, spec.world);
  out.close('}');
  return text;
}

Json to_json(const FrameSpec& spec) { return Json::parse(canonical_text(spec)); }

Result<FrameSpec> frame_spec_from_json(const Json& json, const std::string& what) {
  const Result<int> version = json_field<int>(json, "version", what);
  if (!version) return forward_error(version);
  if (*version != kFrameSpecVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} is a frame spec of version {}; this program reads version {}", what, *version,
                kFrameSpecVersion);
  }
  try {
    return read(json);
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{} is not a frame spec: {}", what, error.what());
  }
}

std::string non_finite_part(const FrameSpec& spec) {
  const auto finite = [](std::initializer_list<double> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  const auto finite_color = [&](const Rgb& color) {
    return finite({color[0], color[1], color[2]});
  };
  const CameraSpec& camera = spec.camera;
  if (!finite({camera.focal_px[0], camera.focal_px[1], camera.center_px[0], camera.center_px[1],
               camera.clip_start_m, camera.clip_end_m, camera.aperture_radius_m,
               camera.focus_distance_m})) {
    return "the camera";
  }
  if (!finite_color(spec.world.color) || !spec.world.map_from_camera.allFinite()) {
    return "the world";
  }
  for (const MaterialSpec& material : spec.materials) {
    if (!finite_color(material.base_color)) return "the colour of a material";
  }
  for (const LightSpec& light : spec.lights) {
    if (!finite_color(light.color) || !finite({light.power}) ||
        !light.camera_from_light.matrix().allFinite()) {
      return "a light";
    }
  }
  return {};
}

std::string frame_id(const FrameSpec& spec) { return sha256_hex(canonical_text(spec)); }

}  // namespace seedframe
