// Small meshes that the geometry tests share.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/portable_math.h"
#include "mesh/mesh.h"

namespace seedframe {

/// Sides of 2 m around the origin, outward; two slots: "sides" and "caps" (top and bottom); each
/// side has the whole UV square, so the edges are UV seams.
inline Mesh example_cube() {
  Mesh mesh;
  for (const float z : {-1.0f, 1.0f}) {
    for (const float y : {-1.0f, 1.0f}) {
      for (const float x : {-1.0f, 1.0f}) mesh.positions.push_back({x, y, z});
    }
  }
  const std::uint32_t quads[6][4] = {{0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7},
                                     {2, 0, 4, 6}, {4, 5, 7, 6}, {2, 3, 1, 0}};
  for (std::size_t side = 0; side < 6; ++side) {
    const auto& q = quads[side];
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
    mesh.corner_uvs.insert(mesh.corner_uvs.end(), {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}});
    mesh.corner_uvs.insert(mesh.corner_uvs.end(), {{0.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}});
    mesh.triangle_slots.insert(mesh.triangle_slots.end(), 2, side < 4 ? 0u : 1u);
  }
  mesh.slot_names = {"sides", "caps"};
  mesh.smooth_angle_rad = 0.5;
  return mesh;
}

/// A wavy patch of 2·n² triangles, 0.3 m × 0.2 m, with continuous UVs and one slot.
inline Mesh example_patch(std::uint32_t n) {
  Mesh mesh;
  std::vector<std::array<float, 2>> uvs;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double u = static_cast<double>(i) / n;
      const double v = static_cast<double>(j) / n;
      const double z = 0.02 * portable::sin(9.0 * u) * portable::cos(7.0 * v);
      mesh.positions.push_back(
          {static_cast<float>(0.3 * u), static_cast<float>(0.2 * v), static_cast<float>(z)});
      uvs.push_back({static_cast<float>(3.0 * u), static_cast<float>(2.0 * v)});
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i;
      for (const auto& triangle :
           {std::array{a, a + 1, a + n + 2}, std::array{a, a + n + 2, a + n + 1}}) {
        mesh.triangles.push_back(triangle);
        mesh.triangle_slots.push_back(0);
        for (const std::uint32_t index : triangle) mesh.corner_uvs.push_back(uvs[index]);
      }
    }
  }
  mesh.slot_names = {"patch"};
  return mesh;
}

/// Six times the signed volume: positive when a closed mesh faces outward.
inline double signed_volume_6(const Mesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& p = mesh.positions[a];
    const auto& q = mesh.positions[b];
    const auto& r = mesh.positions[c];
    volume += p[0] * (double{q[1]} * r[2] - double{q[2]} * r[1]) -
              p[1] * (double{q[0]} * r[2] - double{q[2]} * r[0]) +
              p[2] * (double{q[0]} * r[1] - double{q[1]} * r[0]);
  }
  return volume;
}

}  // namespace seedframe
