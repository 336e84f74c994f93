// Not CGAL's constrained triangulation: it merges corners at one place, as the ends of a bridge to
// a hole are, and has no answer to a polygon that crosses itself.
#include "mesh_files/triangulate.h"

#include <Eigen/Geometry>
#include <numeric>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace seedframe {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
using Ring = std::vector<std::size_t>;

Eigen::Vector3d newell_normal(const std::vector<Eigen::Vector3d>& corners) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // Relative to the first corner, or coordinates far from the origin would cancel.
    const Eigen::Vector3d a = corners[i] - corners[0];
    const Eigen::Vector3d b = corners[(i + 1) % corners.size()] - corners[0];
    normal += a.cross(b);
  }
  return normal;
}

// Drops the axis in which the polygon is thinnest, keeping it counter-clockwise.
std::vector<Point> project(const std::vector<Eigen::Vector3d>& corners) {
  const Eigen::Vector3d normal = newell_normal(corners);
  Eigen::Index drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  Eigen::Index u = (drop + 1) % 3;
  Eigen::Index v = (drop + 2) % 3;
  if (normal[drop] < 0.0) std::swap(u, v);
  std::vector<Point> flat;
  flat.reserve(corners.size());
  for (const auto& corner : corners) {
    flat.emplace_back(corner[u] - corners[0][u], corner[v] - corners[0][v]);
  }
  return flat;
}

bool is_inside(const Point& a, const Point& b, const Point& c, const Point& p) {
  return !CGAL::right_turn(a, b, p) && !CGAL::right_turn(b, c, p) && !CGAL::right_turn(c, a, p);
}

// Whether the corner at ring[i] can be cut off: convex, and no other corner in its triangle.
bool is_ear(const std::vector<Point>& points, const Ring& ring, std::size_t i) {
  const std::size_t n = ring.size();
  const std::size_t before = ring[(i + n - 1) % n];
  const std::size_t after = ring[(i + 1) % n];
  const Point& a = points[before];
  const Point& b = points[ring[i]];
  const Point& c = points[after];
  if (!CGAL::left_turn(a, b, c)) return false;
  for (const std::size_t other : ring) {
    const Point& p = points[other];
    // Corners that coincide with the triangle's own (a bridge to a hole) do not block it.
    if (p == a || p == b || p == c) continue;
    if (is_inside(a, b, c, p)) return false;
  }
  return true;
}

// The shorter diagonal of a quad makes the better triangles: begin at a corner that it cuts off.
std::size_t first_candidate(const std::vector<Eigen::Vector3d>& corners) {
  if (corners.size() != 4) return 1;
  const double across_1 = (corners[2] - corners[0]).squaredNorm();
  const double across_0 = (corners[3] - corners[1]).squaredNorm();
  return across_1 <= across_0 ? 1 : 0;
}

}  // namespace

std::vector<std::array<std::size_t, 3>> triangulate(const std::vector<Eigen::Vector3d>& corners) {
  std::vector<std::array<std::size_t, 3>> triangles;
  if (corners.size() < 3) return triangles;
  const std::vector<Point> points = project(corners);
  Ring ring(corners.size());
  std::iota(ring.begin(), ring.end(), std::size_t{0});
  std::size_t i = first_candidate(corners);
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    std::size_t tried = 0;
    while (tried < n && !is_ear(points, ring, i % n)) {
      ++i;
      ++tried;
    }
    i %= n;
    triangles.push_back({ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    // Going on behind the cut spreads the triangles; cutting the same place again would make a fan.
    ++i;
  }
  triangles.push_back({ring[0], ring[1], ring[2]});
  return triangles;
}

}  // namespace seedframe
