#include "mesh/mesh_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/cgal_guard.h"
#include "mesh/cgal_surface.h"
#include "mesh/triangle_distance.h"
#include "mesh/triangle_tree.h"

namespace seedframe {
namespace {

using Vector = Eigen::Vector3d;
using Corners = std::array<Vector, 3>;
using Box = Eigen::AlignedBox3d;

Box box_of(const Corners& t) {
  Box box(t[0]);
  return box.extend(t[1]).extend(t[2]);
}

double distance(const Vector& p, const Corners& t) {
  return std::sqrt(squared_distance_to_triangle(p, t[0], t[1], t[2]));
}

// The triangles with an area, and a tree of them.
struct Surface {
  explicit Surface(const Mesh& mesh) {
    for (const auto& triangle : mesh.triangles) {
      std::array<CgalKernel::Point_3, 3> points;
      Corners at;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& p = mesh.positions[triangle[i]];
        points[i] = cgal_point(p);
        at[i] = Vector(p[0], p[1], p[2]);
      }
      if (CGAL::collinear(points[0], points[1], points[2])) continue;
      triangles.emplace_back(points[0], points[1], points[2]);
      corners.push_back(at);
      boxes.push_back(box_of(at));
    }
    tree.insert(triangles.cbegin(), triangles.cend());
    tree.build();
    if (!triangles.empty()) tree.accelerate_distance_queries();
  }

  // A triangle that is among the nearest ones to p.
  std::uint32_t nearest(const Vector& p) const {
    const auto found = tree.closest_point_and_primitive({p.x(), p.y(), p.z()});
    return static_cast<std::uint32_t>(found.second - triangles.cbegin());
  }

  std::vector<std::uint32_t> within(const Box& box, double reach) const {
    const Vector low = box.min().array() - reach;
    const Vector high = box.max().array() + reach;
    std::vector<CgalTriangles::const_iterator> found;
    tree.all_intersected_primitives(
        CgalKernel::Iso_cuboid_3({low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}),
        std::back_inserter(found));
    std::vector<std::uint32_t> numbers;
    numbers.reserve(found.size());
    for (const auto& triangle : found) {
      numbers.push_back(static_cast<std::uint32_t>(triangle - triangles.cbegin()));
    }
    return numbers;
  }

  CgalTriangles triangles;
  std::vector<Corners> corners;
  std::vector<Box> boxes;
  TriangleTree tree;
};

// The greatest distance of a point of one surface from the other one, from below and above.
class DirectedDistance {
 public:
  DirectedDistance(const Surface& to, double tolerance, double lower)
      : to_(to), tolerance_(tolerance), found_{lower, lower} {}

  SurfaceDistance measure(const Surface& from) {
    // Corners first: the greater the distance that is known, the less must be cut.
    std::vector<double> least(from.corners.size(), 0.0);
    for (std::size_t t = 0; t < least.size(); ++t) {
      const Corners& corners = from.corners[t];
      const Vector centre = (corners[0] + corners[1] + corners[2]) / 3.0;
      const Corners& other = to_.corners[to_.nearest(centre)];
      // Convex: no point of the triangle is farther from `other` than its corners are.
      for (const Vector& corner : corners) least[t] = std::max(least[t], distance(corner, other));
      if (least[t] > found_.lower_m) {
        for (const Vector& corner : corners) {
          found_.lower_m = std::max(found_.lower_m, exact_distance(corner));
        }
      }
    }
    for (std::size_t t = 0; t < least.size(); ++t) {
      if (least[t] <= enough()) {
        found_.upper_m = std::max(found_.upper_m, least[t]);
        continue;
      }
      cut(from.corners[t], to_.within(box_of(from.corners[t]), least[t]), 0);
    }
    found_.upper_m = std::max(found_.upper_m, found_.lower_m);
    return found_;
  }

 private:
  double enough() const { return found_.lower_m + tolerance_; }

  double exact_distance(const Vector& p) const {
    return std::sqrt(to_.tree.squared_distance({p.x(), p.y(), p.z()}));
  }

  // `near` holds every triangle that is the nearest one to any point of `part`.
  void cut(const Corners& part, const std::vector<std::uint32_t>& near, int depth) {
    std::array<double, 3> nearest;
    nearest.fill(std::numeric_limits<double>::infinity());
    double one_triangle = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : near) {
      double farthest = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double d = distance(part[i], to_.corners[t]);
        nearest[i] = std::min(nearest[i], d);
        farthest = std::max(farthest, d);
      }
      one_triangle = std::min(one_triangle, farthest);
    }
    const double at_corners = *std::max_element(nearest.begin(), nearest.end());
    found_.lower_m = std::max(found_.lower_m, at_corners);
    std::array<double, 3> sides{};
    for (std::size_t i = 0; i < 3; ++i) sides[i] = (part[(i + 1) % 3] - part[i]).norm();
    const auto longest =
        static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
    // No point is farther than this from its nearest corner, and distances change no faster.
    const double upper = std::min(one_triangle, at_corners + sides[longest] / std::sqrt(3.0));
    constexpr std::size_t kMostSteps = 200'000'000;
    constexpr int kDeepest = 60;
    steps_ += near.size();
    if (upper <= enough() || steps_ > kMostSteps || depth == kDeepest) {
      found_.upper_m = std::max(found_.upper_m, upper);
      return;
    }
    const Vector middle = 0.5 * (part[longest] + part[(longest + 1) % 3]);
    for (const std::size_t replaced : {longest, (longest + 1) % 3}) {
      Corners half = part;
      half[replaced] = middle;
      cut(half, still_near(half, near, upper), depth + 1);
    }
  }

  std::vector<std::uint32_t> still_near(const Corners& part, const std::vector<std::uint32_t>& near,
                                        double reach) const {
    const Box box = box_of(part);
    const double squared = reach * reach * (1.0 + 1e-9);  // rounding must not lose the nearest
    std::vector<std::uint32_t> kept;
    kept.reserve(near.size());
    for (const std::uint32_t t : near) {
      if (box.squaredExteriorDistance(to_.boxes[t]) <= squared) kept.push_back(t);
    }
    return kept;
  }

  const Surface& to_;
  double tolerance_;
  SurfaceDistance found_;
  std::size_t steps_ = 0;
};

double greatest_sampled(const Surface& from, const Surface& to) {
  double greatest = 0.0;
  const auto look = [&](const Vector& p) {
    greatest = std::max(greatest, to.tree.squared_distance({p.x(), p.y(), p.z()}));
  };
  for (const auto& [a, b, c] : from.corners) {
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
    const Surface first(a);
    const Surface second(b);
    if (first.corners.empty() || second.corners.empty()) return fail_without_surface(what);
    return SurfaceDistance{
        .lower_m = std::max(greatest_sampled(first, second), greatest_sampled(second, first)),
        .upper_m = std::numeric_limits<double>::infinity()};
  });
}

Result<SurfaceDistance> hausdorff_distance(const Mesh& a, const Mesh& b, double tolerance_m,
                                           const std::string& what) {
  return guard_cgal(what + ": measuring a distance", [&]() -> Result<SurfaceDistance> {
    const Surface first(a);
    const Surface second(b);
    if (first.corners.empty() || second.corners.empty()) return fail_without_surface(what);
    const SurfaceDistance there = DirectedDistance(second, tolerance_m, 0.0).measure(first);
    const SurfaceDistance back =
        DirectedDistance(first, tolerance_m, there.lower_m).measure(second);
    return SurfaceDistance{.lower_m = back.lower_m,
                           .upper_m = std::max(there.upper_m, back.upper_m)};
  });
}

}  // namespace seedframe
