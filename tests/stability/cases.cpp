#include "tests/stability/cases.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <fmt/format.h>

#include "base/philox.h"
#include "base/portable_math.h"
#include "base/sha256.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

using Eigen::Vector3d;

constexpr int kFrames = 4;
constexpr double kHalfWidth = 0.2;  // of what is seen, metres, at the parts' distance

/// Uniform numbers in the order in which they are asked for.
class Draws {
 public:
  explicit Draws(const std::string& name) : stream_(17, name) {}
  double operator()(double low, double high) {
    return low + (high - low) * stream_.uniform({0, 0, next_++, 0});
  }
  Eigen::Quaterniond rotation() {
    const Vector3d axis((*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1));
    return Eigen::Quaterniond(Eigen::AngleAxisd((*this)(0, 6.28), axis.normalized()));
  }

 private:
  PhiloxStream stream_;
  std::uint32_t next_ = 0;
};

/// Needles: from a point to the rim of a disc of 1 m radius, each a thousandth as wide as long.
Mesh needles() {
  Mesh mesh;
  mesh.slot_names = {"all"};
  constexpr std::uint32_t kCount = 6283;
  mesh.positions.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const double angle = 2.0 * portable::kPi * i / kCount;
    mesh.positions.push_back({static_cast<float>(std::cos(angle)),
                              static_cast<float>(std::sin(angle)),
                              static_cast<float>(0.2 * std::sin(5 * angle))});
  }
  for (std::uint32_t i = 0; i < kCount; ++i) {
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % kCount});
    mesh.triangle_slots.push_back(0);
    for (int c = 0; c < 3; ++c) mesh.corner_uvs.push_back({0, 0});
  }
  return mesh;
}

/// Every triangle of a cube twice, once in each sense.
Mesh double_sided_cube() {
  Mesh mesh = example_cube();
  const Mesh once = mesh;
  for (std::size_t t = 0; t < once.triangles.size(); ++t) {
    const auto& [a, b, c] = once.triangles[t];
    mesh.triangles.push_back({a, c, b});
    mesh.triangle_slots.push_back(once.triangle_slots[t]);
    for (std::size_t k = 0; k < 3; ++k) mesh.corner_uvs.push_back(once.corner_uvs[3 * t + k]);
  }
  return mesh;
}

Affine placed(const Vector3d& at, double scale, const Eigen::Quaterniond& turn) {
  Affine map = Affine::Identity();
  map.translate(at).rotate(turn).scale(scale);
  return map;
}

const Eigen::Quaterniond kUpright = Eigen::Quaterniond::Identity();

}  // namespace

StabilityScenes::StabilityScenes(AssetLibrary library) {
  for (const char* name : {"gear", "hex_bolt", "mug", "teapot", "toy_car", "carton"}) {
    const auto asset = library.load(name);
    if (!asset) {
      std::fprintf(stderr, "%s\n", asset.error().message.c_str());
      std::exit(1);
    }
    buffers_[(*asset)->buffer_sha256] =
        std::shared_ptr<const std::string>(*asset, &(*asset)->buffer);
    parts_.emplace_back((*asset)->buffer_sha256,
                        static_cast<int>((*asset)->mesh.slot_names.size()));
  }
  add_distances();
  add_scales();
  add_fields_of_view();
  add_thin_and_coincident();
  add_touching_and_nested();
  add_tiny_and_cut();
}

std::string StabilityScenes::add_mesh(const Mesh& mesh) {
  const auto bytes = std::make_shared<const std::string>(mesh_buffer(mesh));
  const std::string name = sha256_hex(*bytes);
  buffers_[name] = bytes;
  return name;
}

InstanceSpec StabilityScenes::instance(const std::string& mesh, int slots,
                                       const Affine& camera_from_object) {
  InstanceSpec spec;
  spec.mesh = mesh;
  spec.materials.assign(static_cast<std::size_t>(slots), 0);
  spec.camera_from_object = camera_from_object;
  return spec;
}

void StabilityScenes::add(const std::string& group, const std::string& name,
                          std::vector<FrameSpec> frames) {
  for (FrameSpec& frame : frames) {
    for (std::size_t i = 0; i < frame.instances.size(); ++i) {
      frame.instances[i].id = static_cast<int>(i) + 1;
      frame.instances[i].category = 1;
      frame.instances[i].name = fmt::format("thing/{}", i);
    }
  }
  cases_.push_back({group, name, std::move(frames), {}});
}

FrameSpec StabilityScenes::empty_frame(const View& view) const {
  FrameSpec spec;
  spec.render = {320, 240, 1, 1, 0, 1.5, 0.0, false, false, {}, Denoise::kOff, {}};
  const double focal = 160.0 / std::tan(0.5 * view.fov_deg * portable::kPi / 180.0);
  spec.camera.focal_px = {focal, focal};
  spec.camera.center_px = {159.5, 119.5};
  spec.camera.clip_start_m = view.clip_start_m * view.scale;
  spec.camera.clip_end_m = 1000.0 * view.scale;
  spec.world.color = {1, 1, 1};
  spec.world.strength = 1.0;
  spec.materials.emplace_back();
  return spec;
}

std::vector<FrameSpec> StabilityScenes::parts(const View& view) {
  const double distance = kHalfWidth / std::tan(0.5 * view.fov_deg * portable::kPi / 180.0);
  Draws draw("parts");  // the same parts in every view
  // A camera that is turned, so that its axes are not those of the world.
  const Affine camera = placed(view.offset_m * Vector3d(1, 1, 1).normalized(), 1.0,
                               Eigen::Quaterniond(0.8, 0.1, 0.5, 0.3).normalized());
  std::vector<FrameSpec> frames;
  for (int f = 0; f < kFrames; ++f) {
    FrameSpec spec = empty_frame(view);
    for (int i = 0; i < 12; ++i) {
      const auto& [mesh, slots] = parts_[static_cast<std::size_t>(i) % parts_.size()];
      const Vector3d at(draw(-1, 1) * kHalfWidth, draw(-0.75, 0.75) * kHalfWidth,
                        -distance + draw(-0.5, 0.5) * kHalfWidth);
      const Affine seen = placed(view.scale * at, view.scale * draw(0.5, 1.0), draw.rotation());
      // Through the world and back, as a config's frames go.
      const Affine world_from_object = camera * seen;
      spec.instances.push_back(instance(mesh, slots, camera.inverse() * world_from_object));
    }
    frames.push_back(std::move(spec));
  }
  return frames;
}

void StabilityScenes::add_distances() {
  for (const double metres : {0.0, 1e2, 1e4, 1e6}) {
    add("distance from the world's origin", fmt::format("{:g} m", metres),
        parts({.offset_m = metres}));
  }
  for (const double metres : {1e2, 1e4, 1e6}) {
    add("the same, not relative to the camera", fmt::format("{:g} m", metres), parts({}));
    const double each = metres / std::sqrt(3.0);
    cases_.back().blender_origin_m = {each, each, each};
  }
}

void StabilityScenes::add_scales() {
  for (const double scale : {1e-3, 1e-2, 1e-1, 1e1, 1e2, 1e3, 1e4}) {
    add("scale of the scene", fmt::format("{:g}", scale), parts({.scale = scale}));
  }
}

void StabilityScenes::add_fields_of_view() {
  for (const double degrees : {1.0, 5.0, 20.0, 90.0, 120.0, 150.0}) {
    add("field of view", fmt::format("{:g}°", degrees), parts({.fov_deg = degrees}));
  }
}

void StabilityScenes::add_thin_and_coincident() {
  const std::string thin = add_mesh(needles());
  const std::string doubled = add_mesh(double_sided_cube());
  const std::string cube = add_mesh(example_cube());
  std::vector<FrameSpec> slivers, coincident, same, coplanar;
  Draws draw("thin");
  for (int f = 0; f < kFrames; ++f) {
    slivers.push_back(empty_frame({}));
    coincident.push_back(empty_frame({}));
    same.push_back(empty_frame({}));
    coplanar.push_back(empty_frame({}));
    for (int i = 0; i < 8; ++i) {
      const Vector3d at(draw(-0.2, 0.2), draw(-0.15, 0.15), draw(-0.6, -0.4));
      const Eigen::Quaterniond turn = draw.rotation();
      slivers.back().instances.push_back(instance(thin, 1, placed(at, 0.08, turn)));
      coincident.back().instances.push_back(instance(doubled, 2, placed(at, 0.04, turn)));
      for (int twice = 0; twice < 2; ++twice) {
        same.back().instances.push_back(instance(cube, 2, placed(at, 0.04, turn)));
      }
    }
    // Cubes of several sizes whose front faces lie in one plane, tilted towards the camera.
    const Eigen::Quaterniond tilt(
        Eigen::AngleAxisd(draw(0.1, 0.9), Vector3d(1, 0.3, 0).normalized()));
    for (int i = 0; i < 8; ++i) {
      const double half = draw(0.02, 0.05);
      const Vector3d at =
          Vector3d(0, 0, -0.5) + tilt * Vector3d(draw(-0.12, 0.12), draw(-0.1, 0.1), -half);
      coplanar.back().instances.push_back(instance(cube, 2, placed(at, half, tilt)));
    }
  }
  add("thin and coincident", "slivers of 1 : 1000", std::move(slivers));
  add("thin and coincident", "every face twice in one mesh", std::move(coincident));
  add("thin and coincident", "two instances at one place", std::move(same));
  add("thin and coincident", "overlapping faces in one plane", std::move(coplanar));
}

void StabilityScenes::add_touching_and_nested() {
  const std::string cube = add_mesh(example_cube());
  std::vector<FrameSpec> touching, nested, inside;
  Draws draw("touching");
  for (int f = 0; f < kFrames; ++f) {
    const Eigen::Quaterniond turn = draw.rotation();
    touching.push_back(empty_frame({}));
    nested.push_back(empty_frame({}));
    inside.push_back(empty_frame({}));
    for (int i = 0; i < 27; ++i) {  // a block of cubes, face to face
      const Vector3d at(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      touching.back().instances.push_back(
          instance(cube, 2, placed(Vector3d(0, 0, -0.5) + turn * (0.08 * at), 0.04, turn)));
    }
    for (int i = 0; i < 10; ++i) {
      nested.back().instances.push_back(
          instance(cube, 2, placed({0, 0, -0.5}, 0.1 * std::pow(0.9, i), turn)));
      // Around the camera, the least of them the one that is seen.
      inside.back().instances.push_back(
          instance(cube, 2, placed({0, 0, 0}, 0.1 * std::pow(1.2, i), turn)));
    }
    for (int i = 0; i < 4; ++i) {  // and something in the innermost
      const Vector3d at(draw(-0.05, 0.05), draw(-0.04, 0.04), draw(-0.08, -0.04));
      inside.back().instances.push_back(instance(cube, 2, placed(at, 0.01, draw.rotation())));
    }
  }
  add("touching and nested", "27 cubes face to face", std::move(touching));
  add("touching and nested", "10 cubes one in the other", std::move(nested));
  add("touching and nested", "the camera inside 10 cubes", std::move(inside));
}

void StabilityScenes::add_tiny_and_cut() {
  const std::string cube = add_mesh(example_cube());
  std::vector<FrameSpec> tiny, crowd;
  Draws draw("tiny");
  for (int f = 0; f < kFrames; ++f) {
    tiny.push_back(empty_frame({}));
    crowd.push_back(empty_frame({}));
    for (int i = 0; i < 20; ++i) {
      const Eigen::Quaterniond turn = draw.rotation();
      // A pixel is 2.9 mm wide at 1 m. One after the other on the ray of one pixel:
      const double depth = 1.0 + 0.05 * i;
      tiny.back().instances.push_back(
          instance(cube, 2, placed(depth * Vector3d(0.1, 0.07, -1), 0.001, turn)));
      crowd.back().instances.push_back(
          instance(cube, 2, placed(Vector3d(draw(-0.3, 0.3), draw(-0.2, 0.2), -1), 0.0015, turn)));
    }
  }
  add("tiny and cut", "20 objects behind one pixel", std::move(tiny));
  add("tiny and cut", "20 objects of about a pixel", std::move(crowd));
  // The parts are at 0.43 m, ± 0.1 m and their own size.
  for (const double metres : {0.35, 0.43, 0.5}) {
    add("tiny and cut", fmt::format("near plane through the parts, at {:g} m", metres),
        parts({.clip_start_m = metres}));
  }
}

}  // namespace seedframe
