#include "geometry/collision.h"

#include <Eigen/SVD>
#include <array>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace seedframe {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Point to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
Eigen::Vector3d to_vector(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// The box that holds a box after a map.
BoundingBox mapped(const BoundingBox& box, const Eigen::Affine3d& map) {
  const Eigen::Vector3d half = 0.5 * box.size();
  const Eigen::Vector3d centre = map * box.centre();
  const Eigen::Vector3d reach = map.linear().cwiseAbs() * half;
  return {centre - reach, centre + reach};
}

bool overlap(const BoundingBox& a, const BoundingBox& b, double gap) {
  return ((a.low.array() - gap) <= b.high.array()).all() &&
         ((b.low.array() - gap) <= a.high.array()).all();
}

}  // namespace

struct SolidMesh::Tree {
  std::vector<Triangle> triangles;
  AabbTree tree;
};

SolidMesh::SolidMesh(const Mesh& mesh) : tree_(std::make_unique<Tree>()) {
  const auto corner = [&](std::uint32_t index) {
    const auto& p = mesh.positions[index];
    return Point(p[0], p[1], p[2]);
  };
  for (const auto& t : mesh.triangles) {
    const Triangle triangle(corner(t[0]), corner(t[1]), corner(t[2]));
    if (!triangle.is_degenerate()) tree_->triangles.push_back(triangle);
  }
  tree_->tree.insert(tree_->triangles.begin(), tree_->triangles.end());
  tree_->tree.build();
}

SolidMesh::~SolidMesh() = default;

namespace {

/// An odd number of crossings on the way out: inside. The direction is no axis, so that rays seldom
/// run along edges.
bool inside(const Point& point, const SolidMesh::Tree& solid) {
  const Kernel::Ray_3 ray(point, Kernel::Vector_3(0.5377, 0.2113, 0.8163));
  return solid.tree.number_of_intersected_primitives(ray) % 2 == 1;
}

/// Asks `b` of every triangle of `a` that may be near it, in the object space of b.
bool meets(const SolidInstance& a, const SolidInstance& b, double gap_m) {
  const Eigen::Affine3d b_from_a = b.world_from_object.inverse() * a.world_from_object;
  const SolidMesh::Tree& tree_a = a.mesh->tree();
  const SolidMesh::Tree& tree_b = b.mesh->tree();
  // The gap in b's units, by the longest that such a unit is in the world.
  const Eigen::Matrix3d linear = b.world_from_object.linear();
  const double gap = gap_m / Eigen::JacobiSVD<Eigen::Matrix3d>(linear).singularValues()(0);
  for (const Triangle& triangle : tree_a.triangles) {
    std::array<Point, 3> corners;
    BoundingBox box{Eigen::Vector3d::Constant(1e300), Eigen::Vector3d::Constant(-1e300)};
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d corner = b_from_a * to_vector(triangle[i]);
      corners[static_cast<std::size_t>(i)] = to_point(corner);
      box.low = box.low.cwiseMin(corner);
      box.high = box.high.cwiseMax(corner);
    }
    if (!overlap(box, b.box, gap)) continue;
    const Triangle moved(corners[0], corners[1], corners[2]);
    if (!moved.is_degenerate() && tree_b.tree.do_intersect(moved)) return true;
    if (gap <= 0.0) continue;
    for (const Point& corner : corners) {
      if (tree_b.tree.squared_distance(corner) < gap * gap) return true;
    }
  }
  return !tree_a.triangles.empty() &&
         inside(to_point(b_from_a * to_vector(tree_a.triangles.front()[0])), tree_b);
}

}  // namespace

bool nearer_than(const SolidInstance& a, const SolidInstance& b, double gap_m) {
  if (!overlap(mapped(a.box, a.world_from_object), mapped(b.box, b.world_from_object), gap_m)) {
    return false;
  }
  return meets(a, b, gap_m) || meets(b, a, gap_m);
}

}  // namespace seedframe
