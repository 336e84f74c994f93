#include "mesh/corner_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/portable_math.h"

namespace seedframe {
namespace {

using Eigen::Vector3d;
using CornerIndices = std::array<std::uint32_t, 3>;

/// Sets that grow together: corner 3t + k stands for corner k of triangle t.
class CornerSets {
 public:
  explicit CornerSets(std::size_t corners) : parent_(corners) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t corner) {
    while (parent_[corner] != corner) {
      parent_[corner] = parent_[parent_[corner]];
      corner = parent_[corner];
    }
    return corner;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// One triangle's side, from its corner `corner` to the next.
struct HalfEdge {
  std::uint32_t low = 0;   ///< the smaller of its two vertices
  std::uint32_t high = 0;  ///< the larger
  std::size_t corner = 0;
};

std::size_t next_corner(std::size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

class Shading {
 public:
  Shading(std::span<const std::array<float, 3>> positions, std::span<const CornerIndices> triangles)
      : positions_(positions), triangles_(triangles), normals_(triangles.size()) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Vector3d a = point(3 * t);
      normals_[t] = (point(3 * t + 1) - a).cross(point(3 * t + 2) - a).stableNormalized();
    }
  }

  const Vector3d& normal(std::size_t triangle) const { return normals_[triangle]; }

  std::uint32_t vertex(std::size_t corner) const { return triangles_[corner / 3][corner % 3]; }

  /// The triangle's angle at one of its corners.
  double angle(std::size_t corner) const {
    const std::size_t next = next_corner(corner);
    const Vector3d a = (point(next) - point(corner)).stableNormalized();
    const Vector3d b = (point(next_corner(next)) - point(corner)).stableNormalized();
    return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
  }

  /// Both triangles' corners at both ends of every smooth edge.
  CornerSets smooth_sets(double least_cosine) const {
    CornerSets sets(3 * triangles_.size());
    const std::vector<HalfEdge> edges = sorted_edges();
    std::size_t end = 0;
    for (std::size_t i = 0; i < edges.size(); i = end) {
      end = i + 1;
      while (end < edges.size() && edges[end].low == edges[i].low &&
             edges[end].high == edges[i].high) {
        ++end;
      }
      if (end - i != 2) continue;
      const std::size_t a = edges[i].corner;
      const std::size_t b = edges[i + 1].corner;
      if (vertex(a) == vertex(b)) continue;  // they run the same way: one of the two is inside out
      if (normals_[a / 3].dot(normals_[b / 3]) < least_cosine) continue;
      sets.join(a, next_corner(b));
      sets.join(next_corner(a), b);
    }
    return sets;
  }

 private:
  Vector3d point(std::size_t corner) const {
    const std::array<float, 3>& p = positions_[vertex(corner)];
    return {p[0], p[1], p[2]};
  }

  std::vector<HalfEdge> sorted_edges() const {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * triangles_.size());
    for (std::size_t corner = 0; corner < 3 * triangles_.size(); ++corner) {
      const std::uint32_t from = vertex(corner);
      const std::uint32_t to = vertex(next_corner(corner));
      edges.push_back({std::min(from, to), std::max(from, to), corner});
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
    });
    return edges;
  }

  std::span<const std::array<float, 3>> positions_;
  std::span<const CornerIndices> triangles_;
  std::vector<Vector3d> normals_;  ///< of the triangles
};

std::array<float, 3> as_floats(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

std::vector<std::array<float, 3>> corner_normals(
    std::span<const std::array<float, 3>> positions,
    std::span<const std::array<std::uint32_t, 3>> triangles, double smooth_angle_rad) {
  const Shading shading(positions, triangles);
  const std::size_t corners = 3 * triangles.size();
  std::vector<std::array<float, 3>> result(corners);
  if (smooth_angle_rad <= 0.0) {
    for (std::size_t c = 0; c < corners; ++c) result[c] = as_floats(shading.normal(c / 3));
    return result;
  }
  const double least_cosine = smooth_angle_rad >= portable::kPi ? -2.0 : std::cos(smooth_angle_rad);
  CornerSets sets = shading.smooth_sets(least_cosine);
  std::vector<Vector3d> sums(corners, Vector3d::Zero());
  for (std::size_t c = 0; c < corners; ++c) {
    sums[sets.find(c)] += shading.angle(c) * shading.normal(c / 3);
  }
  for (std::size_t c = 0; c < corners; ++c) {
    result[c] = as_floats(sums[sets.find(c)].stableNormalized());
  }
  return result;
}

}  // namespace seedframe
