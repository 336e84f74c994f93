#include "spec/frame_spec.h"

#include <algorithm>
#include <cmath>

#include "base/canonical_writer.h"
#include "base/sha256.h"

namespace seedframe {
namespace {

void write_camera(CanonicalWriter& out, const CameraSpec& camera) {
  out.field("aperture_radius_m", camera.aperture_radius_m);
  out.numbers("center_px", camera.center_px);
  out.field("clip_end_m", camera.clip_end_m);
  out.field("clip_start_m", camera.clip_start_m);
  out.numbers("focal_px", camera.focal_px);
  out.field("focus_distance_m", camera.focus_distance_m);
}

void write_image(CanonicalWriter& out, const ImageSettings& image) {
  out.field("display", image.display);
  out.field("exposure_stops", image.exposure_stops);
  out.field("gamma", image.gamma);
  out.field("look", image.look);
  out.field("view", image.view);
}

void write_keypoint(CanonicalWriter& out, const Keypoint& keypoint) {
  out.field("inside", keypoint.inside);
  out.field("name", keypoint.name);
  out.matrix("point_m", keypoint.point_m);
}

void write_instance(CanonicalWriter& out, const InstanceSpec& instance) {
  if (!instance.asset.empty()) out.field("asset", instance.asset);
  out.matrix("camera_from_object", instance.camera_from_object.matrix());
  out.field("category", static_cast<double>(instance.category));
  const HiddenFrom& hidden = instance.hidden_from;
  std::vector<std::string_view> hidden_from;
  for (const auto& [flag, name] :
       {std::pair(hidden.camera, "camera"), std::pair(hidden.diffuse, "diffuse"),
        std::pair(hidden.glossy, "glossy"), std::pair(hidden.shadow, "shadow"),
        std::pair(hidden.transmission, "transmission")}) {
    if (flag) hidden_from.emplace_back(name);
  }
  out.list("hidden_from", hidden_from, [&](std::string_view name) { out.text(name); });
  out.field("id", static_cast<double>(instance.id));
  if (!instance.keypoints.empty()) out.objects("keypoints", instance.keypoints, write_keypoint);
  out.numbers("materials", instance.materials);
  out.field("mesh", instance.mesh);
  out.field("name", instance.name);
}

void write_labels(CanonicalWriter& out, const LabelSettings& labels) {
  const bool twin = labels.source == LabelSource::kTwin;
  out.field("source", std::string_view(twin ? "geometry" : "render"));
  if (labels.target != 0) out.field("target", static_cast<double>(labels.target));
  out.field("twin_exact", labels.twin_exact);
}

void write_light(CanonicalWriter& out, const LightSpec& light) {
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

void write_material(CanonicalWriter& out, const MaterialSpec& material) {
  out.numbers("base_color", material.base_color);
  out.field("clearcoat", material.clearcoat);
  out.field("ior", material.ior);
  out.field("metallic", material.metallic);
  out.field("roughness", material.roughness);
  out.field("specular", material.specular);
  out.field("texture_repeat", material.texture_repeat);
  out.object("textures", material.textures, [](CanonicalWriter& roles, const auto& textures) {
    for (const auto& [role, hash] : textures) roles.field(role, hash);
  });
  out.field("transmission", material.transmission);
}

void write_adaptive(CanonicalWriter& out, const AdaptiveSampling& adaptive) {
  out.field("min_samples", static_cast<double>(adaptive.min_samples));
  out.field("threshold", adaptive.threshold);
}

void write_bounces(CanonicalWriter& out, const BounceLimits& bounces) {
  for (const auto& [limit, kind] :
       {std::pair(bounces.diffuse, "diffuse"), std::pair(bounces.glossy, "glossy"),
        std::pair(bounces.transmission, "transmission"),
        std::pair(bounces.transparent, "transparent")}) {
    if (limit) out.field(kind, static_cast<double>(*limit));
  }
}

/// Only what is used, so that frames without them are as they were before there were any.
void write_levers(CanonicalWriter& out, const RenderLevers& levers) {
  if (levers.bounces != BounceLimits{}) out.object("bounces", levers.bounces, write_bounces);
  if (levers.clamp_direct > 0.0) out.field("clamp_direct", levers.clamp_direct);
  if (levers.filter_glossy > 0.0) out.field("filter_glossy", levers.filter_glossy);
  if (levers.light_threshold > 0.0) out.field("light_threshold", levers.light_threshold);
  if (levers.path_guiding) out.field("path_guiding", levers.path_guiding);
  if (levers.texture_limit_px > 0) {
    out.field("texture_limit_px", static_cast<double>(levers.texture_limit_px));
  }
}

void write_render(CanonicalWriter& out, const RenderSettings& render) {
  if (render.adaptive.threshold > 0.0) {
    out.object("adaptive", render.adaptive, write_adaptive);
  }
  out.field("clamp_indirect", render.clamp_indirect);
  out.field("denoise", std::string_view(kDenoiseNames[static_cast<std::size_t>(render.denoise)]));
  out.field("depth", render.depth);
  out.field("filter_width_px", render.filter_width_px);
  out.field("height", static_cast<double>(render.height));
  if (render.levers != RenderLevers{}) out.object("levers", render.levers, write_levers);
  out.field("max_bounces", static_cast<double>(render.max_bounces));
  out.field("normal", render.normal);
  if (render.region) {
    const PixelRect& region = *render.region;
    out.numbers("region", std::array{region.x, region.y, region.width, region.height});
  }
  out.field("samples", static_cast<double>(render.samples));
  out.field("seed", static_cast<double>(render.seed));
  out.field("width", static_cast<double>(render.width));
}

void write_sensor(CanonicalWriter& out, const SensorSettings& sensor) {
  out.field("blur_px", sensor.blur_px);
  out.field("exposure_stops", sensor.exposure_stops);
  out.field("full_well", sensor.full_well);
  out.field("jpeg_quality", static_cast<double>(sensor.jpeg_quality));
  out.field("read_noise", sensor.read_noise);
  out.field("seed", static_cast<double>(sensor.seed));
  out.numbers("white_balance", sensor.white_balance);
}

void write_world(CanonicalWriter& out, const WorldSpec& world) {
  out.numbers("color", world.color);
  if (!world.hdri.empty()) {
    out.field("hdri", world.hdri);
    out.field("importance_map_px", static_cast<double>(world.importance_map_px));
    out.matrix("map_from_camera", world.map_from_camera);
  }
  out.field("strength", world.strength);
}

int version_of(const FrameSpec& spec) {
  constexpr int kLevers = 6;
  constexpr int kRegions = 7;
  if (spec.sensor) return kFrameSpecVersion;
  if (spec.render.region || spec.labels.target != 0) return kRegions;
  return spec.render.levers != RenderLevers{} ? kLevers : kOldestFrameSpecVersion;
}

void write_frame_spec(CanonicalWriter& out, const FrameSpec& spec) {
  out.object("camera", spec.camera, write_camera);
  out.object("image", spec.image, write_image);
  out.objects("instances", spec.instances, write_instance);
  out.object("labels", spec.labels, write_labels);
  out.objects("lights", spec.lights, write_light);
  out.objects("materials", spec.materials, write_material);
  out.object("render", spec.render, write_render);
  if (spec.sensor) out.object("sensor", *spec.sensor, write_sensor);
  out.field("version", static_cast<double>(version_of(spec)));
  out.object("world", spec.world, write_world);
}

}  // namespace

std::string canonical_text(const FrameSpec& spec) {
  constexpr std::size_t kBytesPerItem = 600;
  std::string text;
  text.reserve((4 + spec.instances.size() + spec.materials.size() + spec.lights.size()) *
               kBytesPerItem);
  CanonicalWriter(text).object(spec, write_frame_spec);
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
