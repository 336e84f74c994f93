#include "tests/stability/exact_hits.h"

#include <algorithm>
#include <optional>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

namespace seedframe {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;

Point exact_point(const Affine& map, const std::array<float, 3>& p) {
  std::array<Number, 3> seen;
  for (int row = 0; row < 3; ++row) {
    seen[static_cast<std::size_t>(row)] = Number(map(row, 0)) * Number(p[0]) +
                                          Number(map(row, 1)) * Number(p[1]) +
                                          Number(map(row, 2)) * Number(p[2]) + Number(map(row, 3));
  }
  return {seen[0], seen[1], seen[2]};
}

/// Of the ray from the origin with z = -1; nothing where it misses.
std::optional<Number> exact_depth(const Vector& ray, const ExactTriangle& triangle) {
  const Point origin(0, 0, 0);
  const Point ahead = origin + ray;
  std::array<Point, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = exact_point(triangle.instance->camera_from_object, triangle.object_corners[k]);
  }
  const std::array<int, 3> sides = {CGAL::orientation(origin, ahead, p[0], p[1]),
                                    CGAL::orientation(origin, ahead, p[1], p[2]),
                                    CGAL::orientation(origin, ahead, p[2], p[0])};
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  if (*least < 0 && *most > 0) return std::nullopt;
  const Vector normal = CGAL::cross_product(p[1] - p[0], p[2] - p[0]);
  const Number slope = normal * ray;
  if (slope == 0) return std::nullopt;  // seen edge-on, it covers nothing
  return normal * (p[0] - origin) / slope;
}

}  // namespace

ExactHit exact_first_hit(const CameraSpec& camera, int x, int y,
                         const std::vector<ExactTriangle>& triangles) {
  const Vector ray((Number(x) - Number(camera.center_px[0])) / Number(camera.focal_px[0]),
                   (Number(camera.center_px[1]) - Number(y)) / Number(camera.focal_px[1]),
                   Number(-1));
  ExactHit hit;
  std::optional<Number> nearest;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::optional<Number> depth = exact_depth(ray, triangles[i]);
    if (!depth || *depth < Number(camera.clip_start_m) || *depth > Number(camera.clip_end_m)) {
      continue;
    }
    if (nearest && *depth == *nearest) {
      const auto& other = triangles[static_cast<std::size_t>(hit.triangle)];
      hit.tie = hit.tie || triangles[i].instance != other.instance;
    } else if (!nearest || *depth < *nearest) {
      nearest = depth;
      hit = {static_cast<int>(i), false, 0.0};
    }
  }
  if (nearest) hit.depth = CGAL::to_double(*nearest);
  return hit;
}

}  // namespace seedframe
