#include "mesh/mesh_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/cgal_guard.h"
#include "mesh/cgal_surface.h"
#include "mesh/triangle_distance.h"
#include "mesh/triangle_search.h"

namespace seedframe {
namespace {

using Vector = Eigen::Vector3d;

double distance(const Vector& p, const TriangleCorners& t) {
  return std::sqrt(squared_distance_to_triangle(p, t[0], t[1], t[2]));
}

// The triangles with an area.
std::vector<TriangleCorners> surface_of(const Mesh& mesh) {
  std::vector<TriangleCorners> triangles;
  for (const auto& triangle : mesh.triangles) {
    std::array<CgalKernel::Point_3, 3> points;
    TriangleCorners corners;
    for (std::size_t i = 0; i < 3; ++i) {
      points[i] = cgal_point(mesh.positions[triangle[i]]);
      corners[i] = vector_of(points[i]);
    }
    if (!CGAL::collinear(points[0], points[1], points[2])) triangles.push_back(corners);
  }
  return triangles;
}

// A convex polygon in a plane: a triangle of which pieces were cut off.
class Polygon {
 public:
  Polygon() = default;
  explicit Polygon(const TriangleCorners& triangle) : count_(3) {
    std::copy(triangle.begin(), triangle.end(), corners_.begin());
  }

  std::span<const Vector> corners() const { return {corners_.data(), count_}; }

  double area() const {
    Vector sum = Vector::Zero();
    for (std::size_t i = 2; i < count_; ++i) {
      sum += (corners_[i - 1] - corners_[0]).cross(corners_[i] - corners_[0]);
    }
    return 0.5 * sum.norm();
  }

  /// What lies on the side of the plane that `normal` points to, and what lies on the other.
  std::pair<Polygon, Polygon> cut(const Vector& on_plane, const Vector& normal) const {
    std::array<double, kMostCorners> height{};
    for (std::size_t i = 0; i < count_; ++i) height[i] = (corners_[i] - on_plane).dot(normal);
    Polygon above;
    Polygon below;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t next = (i + 1) % count_;
      if (height[i] >= 0.0) above.add(corners_[i]);
      if (height[i] <= 0.0) below.add(corners_[i]);
      if ((height[i] < 0.0) == (height[next] < 0.0) || height[i] == 0.0 || height[next] == 0.0) {
        continue;
      }
      const double t = height[i] / (height[i] - height[next]);
      const Vector crossing = corners_[i] + t * (corners_[next] - corners_[i]);
      above.add(crossing);
      below.add(crossing);
    }
    return {above, below};
  }

 private:
  void add(const Vector& corner) {
    if (count_ < kMostCorners) corners_[count_++] = corner;
  }

  // Each cut adds one corner at most, and none is cut more than three times.
  static constexpr std::size_t kMostCorners = 8;
  std::array<Vector, kMostCorners> corners_;
  std::size_t count_ = 0;
};

// The greatest distance of a point of one surface from the other one, from below and above.
class DirectedDistance {
 public:
  DirectedDistance(const TriangleSearch& to, double tolerance, double lower)
      : to_(to), tolerance_(tolerance), found_{lower, lower} {}

  SurfaceDistance measure(const TriangleSearch& from) {
    // Corners first: the greater the distance that is known, the less must be cut.
    const std::vector<TriangleCorners>& parts = from.triangles();
    std::vector<double> least(parts.size(), 0.0);
    for (std::size_t t = 0; t < least.size(); ++t) {
      const TriangleCorners& corners = parts[t];
      const Vector centre = (corners[0] + corners[1] + corners[2]) / 3.0;
      const TriangleCorners& other = to_.triangles()[to_.nearest(centre).triangle];
      // Convex: no point of the triangle is farther from `other` than its corners are.
      for (const Vector& corner : corners) least[t] = std::max(least[t], distance(corner, other));
      if (least[t] > found_.lower_m) {
        for (const Vector& corner : corners) {
          found_.lower_m =
              std::max(found_.lower_m, std::sqrt(to_.nearest(corner).squared_distance));
        }
      }
    }
    for (std::size_t t = 0; t < least.size(); ++t) {
      if (least[t] <= enough()) {
        found_.upper_m = std::max(found_.upper_m, least[t]);
      } else {
        look_at(parts[t], 0);
      }
    }
    found_.upper_m = std::max(found_.upper_m, found_.lower_m);
    return found_;
  }

 private:
  double enough() const { return found_.lower_m + tolerance_; }

  void look_at(const TriangleCorners& part, int depth) {
    const Vector centre = (part[0] + part[1] + part[2]) / 3.0;
    const std::uint32_t at_centre = to_.nearest(centre).triangle;
    double at_corners = 0.0;
    double one_triangle = farthest_from(at_centre, part);
    for (const Vector& corner : part) {
      const TriangleSearch::Nearest nearest = to_.nearest(corner);
      at_corners = std::max(at_corners, nearest.squared_distance);
      one_triangle = std::min(one_triangle, farthest_from(nearest.triangle, part));
    }
    at_corners = std::sqrt(at_corners);
    found_.lower_m = std::max(found_.lower_m, at_corners);
    std::array<double, 3> sides{};
    for (std::size_t i = 0; i < 3; ++i) sides[i] = (part[(i + 1) % 3] - part[i]).norm();
    const auto longest =
        static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
    // No point is farther than this from its nearest corner, and distances change no faster.
    const double upper = std::min(one_triangle, at_corners + sides[longest] / std::sqrt(3.0));
    constexpr std::size_t kMostSteps = 5'000'000;
    constexpr int kDeepest = 200;
    if (upper <= enough() || ++steps_ > kMostSteps || depth == kDeepest) {
      found_.upper_m = std::max(found_.upper_m, upper);
      return;
    }
    // What lies beside a triangle by less than the tolerance is near it, too; but the corners of a
    // sliver that was made wider are far from it.
    if (cut_along(at_centre, part, 0.25 * tolerance_, depth)) return;
    if (cut_along(at_centre, part, 0.0, depth)) return;
    const Vector middle = 0.5 * (part[longest] + part[(longest + 1) % 3]);
    for (const std::size_t replaced : {longest, (longest + 1) % 3}) {
      TriangleCorners half = part;
      half[replaced] = middle;
      look_at(half, depth + 1);
    }
  }

  // Convex: no point between the corners is farther.
  double farthest_from(std::uint32_t triangle, std::span<const Vector> corners) const {
    double farthest = 0.0;
    for (const Vector& corner : corners) {
      farthest = std::max(farthest, distance(corner, to_.triangles()[triangle]));
    }
    return farthest;
  }

  // Cuts away what lies over one triangle of the other surface, made wider by `margin`, if that is
  // near enough, and looks at the rest: where the surfaces are flat, halving would follow every
  // edge of the other one down to the tolerance.
  bool cut_along(std::uint32_t number, const TriangleCorners& part, double margin, int depth) {
    constexpr double kLeastShare = 1e-9;  // rounding must not be taken for progress
    const TriangleCorners& triangle = to_.triangles()[number];
    const Vector normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    Polygon over(part);
    const double least_area = kLeastShare * over.area();
    std::array<Polygon, 3> beside;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector inward = normal.cross(triangle[(i + 1) % 3] - triangle[i]).normalized();
      std::tie(over, beside[i]) = over.cut(triangle[i] - margin * inward, inward);
    }
    if (over.corners().size() < 3 || !(over.area() > least_area)) return false;
    const double farthest = farthest_from(number, over.corners());
    if (farthest > enough()) raise_lower(over);
    if (farthest > enough()) return false;
    found_.upper_m = std::max(found_.upper_m, farthest);
    for (const Polygon& rest : beside) {
      const auto corners = rest.corners();
      for (std::size_t i = 2; i < corners.size(); ++i) {
        look_at({corners[0], corners[i - 1], corners[i]}, depth + 1);
      }
    }
    return true;
  }

  void raise_lower(const Polygon& polygon) {
    for (const Vector& corner : polygon.corners()) {
      found_.lower_m = std::max(found_.lower_m, std::sqrt(to_.nearest(corner).squared_distance));
    }
  }

  const TriangleSearch& to_;
  double tolerance_;
  SurfaceDistance found_;
  std::size_t steps_ = 0;
};

double greatest_sampled(const TriangleSearch& from, const TriangleSearch& to) {
  double greatest = 0.0;
  const auto look = [&](const Vector& p) {
    greatest = std::max(greatest, to.nearest(p).squared_distance);
  };
  for (const auto& [a, b, c] : from.triangles()) {
    for (const Vector& p : {a, b, c}) look(p);
    look(0.5 * (a + b));
    look(0.5 * (b + c));
    look(0.5 * (c + a));
    look((a + b + c) / 3.0);
  }
  return std::sqrt(greatest);
}

tl::unexpected<Error> fail_without_surface(const std::string& what) {
  return fail(ErrorKind::kInput, "{}: there is no surface to measure a distance from", what);
}

}  // namespace

Result<SurfaceDistance> sampled_distance(const Mesh& a, const Mesh& b, const std::string& what) {
  return guard_cgal(what + ": measuring a distance", [&]() -> Result<SurfaceDistance> {
    const TriangleSearch first(surface_of(a));
    const TriangleSearch second(surface_of(b));
    if (first.empty() || second.empty()) return fail_without_surface(what);
    return SurfaceDistance{
        .lower_m = std::max(greatest_sampled(first, second), greatest_sampled(second, first)),
        .upper_m = std::numeric_limits<double>::infinity()};
  });
}

Result<SurfaceDistance> hausdorff_distance(const Mesh& a, const Mesh& b, double tolerance_m,
                                           const std::string& what) {
  return guard_cgal(what + ": measuring a distance", [&]() -> Result<SurfaceDistance> {
    const TriangleSearch first(surface_of(a));
    const TriangleSearch second(surface_of(b));
    if (first.empty() || second.empty()) return fail_without_surface(what);
    const SurfaceDistance there = DirectedDistance(second, tolerance_m, 0.0).measure(first);
    const SurfaceDistance back =
        DirectedDistance(first, tolerance_m, there.lower_m).measure(second);
    return SurfaceDistance{.lower_m = back.lower_m,
                           .upper_m = std::max(there.upper_m, back.upper_m)};
  });
}

}  // namespace seedframe
