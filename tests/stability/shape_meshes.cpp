#include "tests/stability/shape_meshes.h"

#include <cmath>

#include "base/portable_math.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangle_slots.push_back(0);
  mesh.corner_uvs.insert(mesh.corner_uvs.end(), 3, {0, 0});
}

}  // namespace

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
  for (std::uint32_t i = 0; i < kCount; ++i) add_triangle(mesh, 0, 1 + i, 1 + (i + 1) % kCount);
  return mesh;
}

Mesh strips(std::uint32_t first, std::uint32_t of, double aspect) {
  constexpr std::uint32_t kStrips = 400;
  constexpr double kStripWidth = 0.002;
  Mesh mesh;
  mesh.slot_names = {"all"};
  const auto far_z = static_cast<float>(-kStripWidth * aspect);
  for (std::uint32_t strip = first; strip < kStrips; strip += of) {
    const auto corner = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double side : {0.0, 1.0}) {
      const auto x = static_cast<float>(kStripWidth * (strip + side - 0.5 * kStrips));
      mesh.positions.push_back({x, 0, 0});
      mesh.positions.push_back({x, 0, far_z});
    }
    add_triangle(mesh, corner, corner + 2, corner + 3);
    add_triangle(mesh, corner, corner + 3, corner + 1);
  }
  return mesh;
}

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

Mesh square() {
  Mesh mesh;
  mesh.slot_names = {"all"};
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  add_triangle(mesh, 0, 1, 2);
  add_triangle(mesh, 0, 2, 3);
  return mesh;
}

}  // namespace seedframe
