#include "spec/frame_spec.h"

#include <algorithm>
#include <cmath>

#include "base/sha256.h"

namespace seedframe {
namespace {

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
  out.field("kind", std::string_view(kLightKindNames[static_cast<std::size_t>(light.kind)]));
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
  if (render.adaptive.threshold > 0.0) {
    out.key("adaptive");
    out.open('{');
    out.field("min_samples", static_cast<double>(render.adaptive.min_samples));
    out.field("threshold", render.adaptive.threshold);
    out.close('}');
  }
  out.field("clamp_indirect", render.clamp_indirect);
  out.field("denoise", std::string_view(kDenoiseNames[static_cast<std::size_t>(render.denoise)]));
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
    out.field("importance_map_px", static_cast<double>(world.importance_map_px));
    out.matrix("map_from_camera", world.map_from_camera);
  }
  out.field("strength", world.strength);
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
