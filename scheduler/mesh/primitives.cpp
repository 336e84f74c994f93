#include "mesh/primitives.h"

#include "base/portable_math.h"

namespace seedframe {

Mesh ground_surface(double width_m, double depth_m, double curvature_per_m) {
  constexpr std::uint32_t kCellsWhenCurved = 64;
  const std::uint32_t cells = curvature_per_m == 0.0 ? 1 : kCellsWhenCurved;
  const std::uint32_t row = cells + 1;
  Mesh mesh;
  for (std::uint32_t j = 0; j < row; ++j) {
    for (std::uint32_t i = 0; i < row; ++i) {
      const double x = (static_cast<double>(i) / cells - 0.5) * width_m;
      const double y = (static_cast<double>(j) / cells - 0.5) * depth_m;
      const double z = 0.5 * curvature_per_m * (x * x + y * y);
      mesh.positions.push_back(
          {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_slots.push_back(0);
    for (const std::uint32_t corner : {a, b, c}) {
      mesh.corner_uvs.push_back({mesh.positions[corner][0], mesh.positions[corner][1]});
    }
  };
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t corner = j * row + i;
      add(corner, corner + 1, corner + row + 1);
      add(corner, corner + row + 1, corner + row);
    }
  }
  mesh.slot_names = {"ground"};
  mesh.smooth_angle_rad = curvature_per_m == 0.0 ? 0.0 : portable::kPi;
  return mesh;
}

}  // namespace seedframe
