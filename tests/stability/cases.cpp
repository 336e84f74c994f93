#include "tests/stability/cases.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <fmt/format.h>

#include "base/portable_math.h"
#include "base/sha256.h"
#include "tests/stability/draws.h"

namespace seedframe {
namespace {

using Eigen::Vector3d;

constexpr int kFrames = 4;
constexpr int kWidth = 320, kHeight = 240;
constexpr double kHalfWidth = 0.2;  // of what is seen, metres, at the parts' distance

}  // namespace

StabilityScenes::StabilityScenes(AssetLibrary library, std::string only) : only_(std::move(only)) {
  for (const char* name : {"gear", "hex_bolt", "mug", "teapot", "toy_car", "carton"}) {
    const auto asset = library.load(name);
    if (!asset) {
      std::fprintf(stderr, "%s\n", asset.error().message.c_str());
      std::exit(1);
    }
    part_meshes_.push_back((*asset)->mesh);
    parts_.push_back(
        {add_mesh((*asset)->mesh), static_cast<int>((*asset)->mesh.slot_names.size())});
  }
  add_distances();
  add_distances_in_object_space();
  add_scales();
  add_fields_of_view();
  add_grazing();
  add_slivers();
  add_gaps();
  add_many_triangles();
  add_nested_scales();
  add_aspects();
  add_shifts();
  add_clips();
  add_touching_and_nested();
  add_tiny();
}

std::string StabilityScenes::add_mesh(const Mesh& mesh) {
  const auto bytes = std::make_shared<const std::string>(mesh_buffer(mesh));
  const std::string name = sha256_hex(*bytes);
  buffers_[name] = bytes;
  return name;
}

InstanceSpec StabilityScenes::instance(const Part& part, const Affine& camera_from_object) {
  InstanceSpec spec;
  spec.mesh = part.mesh;
  spec.materials.assign(static_cast<std::size_t>(part.slots), 0);
  spec.camera_from_object = camera_from_object;
  return spec;
}

void StabilityScenes::add(const std::string& axis, const std::string& name,
                          std::optional<double> at, std::vector<FrameSpec> frames,
                          const std::array<double, 3>& blender_origin_m) {
  if (axis.find(only_) == std::string::npos) return;
  for (FrameSpec& frame : frames) {
    for (std::size_t i = 0; i < frame.instances.size(); ++i) {
      frame.instances[i].id = static_cast<int>(i) + 1;
      frame.instances[i].category = 1;
      frame.instances[i].name = fmt::format("thing/{}", i);
    }
  }
  cases_.push_back({axis, name, at, std::move(frames), blender_origin_m});
}

FrameSpec StabilityScenes::empty_frame(const View& view) {
  FrameSpec spec;
  RenderSettings& render = spec.render;
  render.width = kWidth;
  render.height = kHeight;
  render.samples = 1;
  render.seed = 1;
  render.depth = render.normal = true;
  const double focal = 0.5 * kWidth / std::tan(0.5 * portable::radians(view.fov_deg));
  spec.camera.focal_px = {focal / std::min(1.0, view.aspect), focal * std::max(1.0, view.aspect)};
  spec.camera.center_px = {0.5 * (kWidth - 1) - view.shift * kWidth, 0.5 * (kHeight - 1)};
  spec.camera.clip_start_m = view.clip_start_m * view.scale;
  spec.camera.clip_end_m = view.clip_end_m * view.scale;
  spec.world.color = {1, 1, 1};
  spec.world.strength = 1.0;
  spec.materials.emplace_back();
  return spec;
}

std::vector<FrameSpec> StabilityScenes::empty_frames(const View& view) {
  std::vector<FrameSpec> frames;
  for (int f = 0; f < kFrames; ++f) frames.push_back(empty_frame(view));
  return frames;
}

std::vector<FrameSpec> StabilityScenes::scattered(const std::vector<Part>& parts,
                                                  const View& view) {
  const double distance = kHalfWidth / std::tan(0.5 * portable::radians(view.fov_deg));
  Draws draw("parts");  // the same parts in every view
  // A camera that is turned, so that its axes are not those of the world.
  const Affine camera = placed(view.offset_m * Vector3d(1, 1, 1).normalized(), 1.0,
                               Eigen::Quaterniond(0.8, 0.1, 0.5, 0.3).normalized());
  std::vector<FrameSpec> frames = empty_frames(view);
  for (FrameSpec& spec : frames) {
    for (std::size_t i = 0; i < 12; ++i) {
      Vector3d at(draw(-1, 1) * kHalfWidth, draw(-0.75, 0.75) * kHalfWidth,
                  -distance + draw(-0.5, 0.5) * kHalfWidth);
      at.x() *= std::min(1.0, view.aspect);
      at.y() /= std::max(1.0, view.aspect);
      at.x() -= at.z() * view.shift * kWidth / spec.camera.focal_px[0];
      const Affine seen = placed(view.scale * at, view.scale * draw(0.5, 1.0), draw.rotation());
      // Through the world and back, as a config's frames go.
      const Affine world_from_object = camera * seen;
      spec.instances.push_back(
          instance(parts[i % parts.size()], camera.inverse() * world_from_object));
    }
  }
  return frames;
}

}  // namespace seedframe
