// The cases whose meshes are hard in themselves.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/portable_math.h"
#include "tests/mesh/example_meshes.h"
#include "tests/stability/cases.h"
#include "tests/stability/draws.h"
#include "tests/stability/shape_meshes.h"

namespace seedframe {

using Eigen::Quaterniond;
using Eigen::Vector3d;

void StabilityScenes::add_grazing() {
  const Part blade = {add_mesh(square()), 1};
  for (const double degrees : {1.0, 0.1, 1e-2, 1e-3, 1e-4}) {
    // No face covers more of the view than its steepest angle: the flatter, the more of them.
    const int blades = std::min(2000, static_cast<int>(40.0 / degrees));
    std::vector<FrameSpec> frames = empty_frames();
    Draws draw("grazing");
    for (FrameSpec& frame : frames) {
      for (int i = 0; i < blades; ++i) {
        const Vector3d seen = Vector3d(draw(-0.45, 0.45), draw(-0.3, 0.3), -1).normalized();
        const Vector3d across = seen.cross(draw.rotation() * Vector3d::UnitX()).normalized();
        const double angle = portable::radians(degrees) * (draw(0, 1) < 0.5 ? -1 : 1);
        const Vector3d along = Quaterniond(Eigen::AngleAxisd(angle, across)) * seen;
        Affine map = Affine::Identity();
        map.linear() << 0.05 * along, 0.1 * across, along.cross(across);
        map.translation() = draw(0.4, 0.6) * seen;
        frame.instances.push_back(instance(blade, map));
      }
    }
    add("faces at a grazing angle", fmt::format("{:g}°", degrees), degrees, std::move(frames));
  }
}

void StabilityScenes::add_slivers() {
  const std::string axis = "slivers";
  const Part fan = {add_mesh(needles()), 1};
  std::vector<FrameSpec> fans = empty_frames();
  Draws draw("fans");
  for (FrameSpec& frame : fans) {
    for (int i = 0; i < 8; ++i) {
      const Vector3d at(draw(-0.2, 0.2), draw(-0.15, 0.15), draw(-0.6, -0.4));
      frame.instances.push_back(instance(fan, placed(at, 0.08, draw.rotation())));
    }
  }
  add(axis, "1 : 1000, fans", std::nullopt, std::move(fans));
  for (const double aspect : {1e3, 1e4, 1e5, 1e6, 1e7}) {
    // A floor 0.3 m below the camera, its strips of four instances by turns.
    constexpr std::uint32_t kInstances = 4;
    std::vector<FrameSpec> frames = empty_frames({.clip_end_m = 1e6});
    Draws turns("floors");
    for (std::uint32_t i = 0; i < kInstances; ++i) {
      const Part part = {add_mesh(strips(i, kInstances, aspect)), 1};
      for (FrameSpec& frame : frames) frame.instances.push_back(instance(part, Affine::Identity()));
    }
    for (FrameSpec& frame : frames) {
      const Quaterniond turn = Eigen::AngleAxisd(turns(-0.3, -0.1), Vector3d::UnitX()) *
                               Eigen::AngleAxisd(turns(-0.2, 0.2), Vector3d::UnitY());
      const Vector3d below(turns(-0.05, 0.05), -0.3, 0.1);
      for (InstanceSpec& part : frame.instances) {
        part.camera_from_object = placed(turn * below, 1.0, turn);
      }
    }
    add(axis, fmt::format("1 : {:g}", aspect), aspect, std::move(frames));
  }
}

void StabilityScenes::add_gaps() {
  const Part cube = {add_mesh(example_cube()), 2};
  for (const double gap : {0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    std::vector<FrameSpec> frames = empty_frames();
    Draws draw("gaps");
    for (FrameSpec& frame : frames) {
      // Cubes of several sizes, their front faces one behind the other and tilted to the camera.
      const Quaterniond tilt(Eigen::AngleAxisd(draw(0.1, 0.9), Vector3d(1, 0.3, 0).normalized()));
      for (int i = 0; i < 8; ++i) {
        const double half = draw(0.02, 0.05);
        const Vector3d front(draw(-0.12, 0.12), draw(-0.1, 0.1), -i * gap);
        const Vector3d at = Vector3d(0, 0, -0.5) + tilt * (front - half * Vector3d::UnitZ());
        frame.instances.push_back(instance(cube, placed(at, half, tilt)));
      }
    }
    add("faces a gap apart", gap == 0.0 ? "in one plane" : fmt::format("{:g} m", gap), gap,
        std::move(frames));
  }
  const Part doubled = {add_mesh(double_sided_cube()), 2};
  std::vector<FrameSpec> coincident = empty_frames(), same = empty_frames();
  Draws draw("coincident");
  for (std::size_t f = 0; f < same.size(); ++f) {
    for (int i = 0; i < 8; ++i) {
      const Vector3d at(draw(-0.2, 0.2), draw(-0.15, 0.15), draw(-0.6, -0.4));
      const Affine map = placed(at, 0.04, draw.rotation());
      coincident[f].instances.push_back(instance(doubled, map));
      same[f].instances.insert(same[f].instances.end(), 2, instance(cube, map));
    }
  }
  add("faces a gap apart", "each face twice in one mesh", std::nullopt, std::move(coincident));
  add("faces a gap apart", "two instances at one place", std::nullopt, std::move(same));
}

void StabilityScenes::add_many_triangles() {
  struct Patch {
    std::uint32_t side;
    std::size_t frames;
  };
  for (const auto& [side, count] : {Patch{71, 4}, Patch{224, 4}, Patch{707, 2}, Patch{2237, 1}}) {
    const Part patch = {add_mesh(example_patch(side)), 1};
    std::vector<FrameSpec> frames = empty_frames();
    frames.resize(count);
    Draws draw("patches");
    for (FrameSpec& frame : frames) {
      const Quaterniond turn = Quaterniond(Eigen::AngleAxisd(draw(-1.0, 1.0), Vector3d::UnitX())) *
                               Quaterniond(Eigen::AngleAxisd(draw(-0.5, 0.5), Vector3d::UnitZ()));
      frame.instances.push_back(
          instance(patch, placed(Vector3d(0, 0, -0.4) - turn * Vector3d(0.15, 0.1, 0), 1, turn)));
    }
    const double triangles = 2.0 * side * side;
    add("triangles of one mesh", fmt::format("{:.2g} million", triangles / 1e6), triangles,
        std::move(frames));
  }
}

void StabilityScenes::add_touching_and_nested() {
  const Part cube = {add_mesh(example_cube()), 2};
  std::vector<FrameSpec> touching = empty_frames(), nested = empty_frames(),
                         inside = empty_frames();
  Draws draw("touching");
  for (std::size_t f = 0; f < touching.size(); ++f) {
    const Quaterniond turn = draw.rotation();
    for (int i = 0; i < 27; ++i) {  // a block of cubes, face to face
      const Vector3d at(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      touching[f].instances.push_back(
          instance(cube, placed(Vector3d(0, 0, -0.5) + turn * (0.08 * at), 0.04, turn)));
    }
    for (int i = 0; i < 10; ++i) {
      nested[f].instances.push_back(
          instance(cube, placed({0, 0, -0.5}, 0.1 * std::pow(0.9, i), turn)));
      // Around the camera, the least of them the one that is seen.
      inside[f].instances.push_back(
          instance(cube, placed({0, 0, 0}, 0.1 * std::pow(1.2, i), turn)));
    }
    for (int i = 0; i < 4; ++i) {  // and something in the innermost
      const Vector3d at(draw(-0.05, 0.05), draw(-0.04, 0.04), draw(-0.08, -0.04));
      inside[f].instances.push_back(instance(cube, placed(at, 0.01, draw.rotation())));
    }
  }
  const std::string axis = "touching, nested, tiny";
  add(axis, "27 cubes face to face", std::nullopt, std::move(touching));
  add(axis, "10 cubes one in the other", std::nullopt, std::move(nested));
  add(axis, "the camera inside 10 cubes", std::nullopt, std::move(inside));
}

void StabilityScenes::add_tiny() {
  const Part cube = {add_mesh(example_cube()), 2};
  std::vector<FrameSpec> tiny = empty_frames(), crowd = empty_frames();
  Draws draw("tiny");
  for (std::size_t f = 0; f < tiny.size(); ++f) {
    for (int i = 0; i < 20; ++i) {
      const Quaterniond turn = draw.rotation();
      // A pixel is 2.9 mm wide at 1 m. One after the other on the ray of one pixel:
      const double depth = 1.0 + 0.05 * i;
      tiny[f].instances.push_back(
          instance(cube, placed(depth * Vector3d(0.1, 0.07, -1), 0.001, turn)));
      crowd[f].instances.push_back(
          instance(cube, placed(Vector3d(draw(-0.3, 0.3), draw(-0.2, 0.2), -1), 0.0015, turn)));
    }
  }
  const std::string axis = "touching, nested, tiny";
  add(axis, "20 objects behind one pixel", std::nullopt, std::move(tiny));
  add(axis, "20 objects of about a pixel", std::nullopt, std::move(crowd));
}

}  // namespace seedframe
