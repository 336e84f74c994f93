#include "mesh/collision.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "mesh/triangle_tree.h"

namespace seedframe {
namespace {

using Point = CgalKernel::Point_3;
using Triangle = CgalKernel::Triangle_3;

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
  CgalTriangles triangles;
  TriangleTree tree;
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
  const CgalKernel::Ray_3 ray(point, CgalKernel::Vector_3(0.5377, 0.2113, 0.8163));
  return solid.tree.number_of_intersected_primitives(ray) % 2 == 1;
}

/// How many metres a unit of an instance's own space is, at most and at least.
struct Stretch {
  explicit Stretch(const Eigen::Affine3d& map) {
    const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(map.linear()).singularValues();
    most = values(0);
    least = values(2);
  }
  bool same_everywhere() const { return most <= least * (1.0 + 1e-9); }
  double most = 1.0;
  double least = 1.0;
};

/// Whether a point, in the space of `b`, is nearer than gap_m to its surface in the world.
bool is_near(const Point& point, const SolidInstance& b, const Stretch& stretch, double gap_m) {
  const SolidMesh::Tree& solid = b.mesh->tree();
  if (stretch.same_everywhere()) {
    const double gap = gap_m / stretch.most;
    return solid.tree.squared_distance(point) < gap * gap;
  }
  // Distances in the space of b are not those of the world: only what may be near is measured.
  const double reach = gap_m / stretch.least;
  const CgalKernel::Vector_3 corner(reach, reach, reach);
  std::vector<TriangleTree::Primitive_id> candidates;
  solid.tree.all_intersected_primitives(CgalKernel::Iso_cuboid_3(point - corner, point + corner),
                                        std::back_inserter(candidates));
  const auto in_world = [&](const Point& p) {
    return cgal_point(b.world_from_object * vector_of(p));
  };
  return std::any_of(candidates.begin(), candidates.end(), [&](const auto& triangle) {
    const Triangle moved(in_world((*triangle)[0]), in_world((*triangle)[1]),
                         in_world((*triangle)[2]));
    return CGAL::squared_distance(in_world(point), moved) < gap_m * gap_m;
  });
}

/// Asks `b` of every triangle of `a` that may be near it, in the object space of b.
bool meets(const SolidInstance& a, const SolidInstance& b, double gap_m) {
  const Eigen::Affine3d b_from_a = b.world_from_object.inverse() * a.world_from_object;
  const SolidMesh::Tree& tree_a = a.mesh->tree();
  const SolidMesh::Tree& tree_b = b.mesh->tree();
  if (tree_a.triangles.empty() || tree_b.triangles.empty()) return false;
  const Stretch stretch(b.world_from_object);
  for (const Triangle& triangle : tree_a.triangles) {
    std::array<Point, 3> corners;
    BoundingBox box{Eigen::Vector3d::Constant(1e300), Eigen::Vector3d::Constant(-1e300)};
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d corner = b_from_a * vector_of(triangle[i]);
      corners[static_cast<std::size_t>(i)] = cgal_point(corner);
      box.low = box.low.cwiseMin(corner);
      box.high = box.high.cwiseMax(corner);
    }
    if (!overlap(box, b.box, gap_m / stretch.least)) continue;
    const Triangle moved(corners[0], corners[1], corners[2]);
    if (!moved.is_degenerate() && tree_b.tree.do_intersect(moved)) return true;
    if (gap_m <= 0.0) continue;
    for (const Point& corner : corners) {
      if (is_near(corner, b, stretch, gap_m)) return true;
    }
  }
  return inside(cgal_point(b_from_a * vector_of(tree_a.triangles.front()[0])), tree_b);
}

}  // namespace

bool nearer_than(const SolidInstance& a, const SolidInstance& b, double gap_m) {
  if (!overlap(mapped(a.box, a.world_from_object), mapped(b.box, b.world_from_object), gap_m)) {
    return false;
  }
  return meets(a, b, gap_m) || meets(b, a, gap_m);
}

}  // namespace seedframe
