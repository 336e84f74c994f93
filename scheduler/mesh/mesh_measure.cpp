#include "mesh/mesh_measure.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>

#include "mesh/mesh_edges.h"

namespace seedframe {
namespace {

std::array<Eigen::Vector3d, 3> corners_of(const Mesh& mesh, std::size_t triangle,
                                          const Eigen::Vector3d& origin) {
  std::array<Eigen::Vector3d, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& p = mesh.positions[mesh.triangles[triangle][i]];
    corners[i] = Eigen::Vector3d(p[0], p[1], p[2]) - origin;
  }
  return corners;
}

// Integrals over the surface, and of what it encloses, about the middle of the box: far from the
// origin they would cancel.
struct Moments {
  double area = 0.0;
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Moments moments_of(const Mesh& mesh, const Eigen::Vector3d& origin) {
  Moments sum;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t, origin);
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const Eigen::Vector3d total = a + b + c;
    sum.area += area;
    sum.volume += a.dot(b.cross(c)) / 6.0;
    sum.first += area / 3.0 * total;
    // The integral of x xᵀ over a triangle.
    sum.second +=
        area / 12.0 *
        (a * a.transpose() + b * b.transpose() + c * c.transpose() + total * total.transpose());
  }
  return sum;
}

// Each axis points to where its largest component is positive; the last one makes it right-handed.
Eigen::Matrix3d axes_of(const Moments& moments) {
  const Eigen::Vector3d mean = moments.first / moments.area;
  const Eigen::Matrix3d covariance = moments.second / moments.area - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Eigen::Matrix3d axes = solver.eigenvectors().rowwise().reverse();  // greatest first
  for (int i = 0; i < 2; ++i) {
    Eigen::Index largest = 0;
    axes.col(i).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, i) < 0.0) axes.col(i) *= -1.0;
  }
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

Eigen::Vector3d extent_along(const Mesh& mesh, const Eigen::Matrix3d& axes) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const auto& p : mesh.positions) {
    const Eigen::Vector3d along = axes.transpose() * Eigen::Vector3d(p[0], p[1], p[2]);
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  return high - low;
}

std::size_t used_vertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  std::size_t count = 0;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      count += used[vertex] ? 0 : 1;
      used[vertex] = true;
    }
  }
  return count;
}

}  // namespace

MeshMeasures measure_mesh(const Mesh& mesh) {
  MeshMeasures out;
  out.box = bounding_box(mesh);
  out.size_m = out.box.size().maxCoeff();
  const Moments moments = moments_of(mesh, out.box.centre());
  out.area_m2 = moments.area;
  const auto uses = edge_uses(mesh);
  std::size_t edges = 0;
  for_each_edge(uses, [&](std::span<const EdgeUse> sides) {
    ++edges;
    if (sides.size() == 1) ++out.boundary_edges;
    if (sides.size() > 1 && !is_manifold_edge(sides)) ++out.bad_edges;
  });
  out.parts = mesh_parts(mesh, uses).count;
  out.watertight = out.boundary_edges == 0 && out.bad_edges == 0;
  if (out.watertight) {
    out.volume_m3 = moments.volume;
    if (non_manifold_vertices(mesh, uses) == 0) {
      // Euler and Poincaré: V - E + F = 2 (parts - genus).
      const long characteristic = static_cast<long>(used_vertices(mesh)) -
                                  static_cast<long>(edges) +
                                  static_cast<long>(mesh.triangles.size());
      out.genus = static_cast<long>(out.parts) - characteristic / 2;
    }
  }
  out.centroid = out.box.centre() + moments.first / moments.area;
  out.principal_axes = axes_of(moments);
  out.principal_size_m = extent_along(mesh, out.principal_axes);
  return out;
}

}  // namespace seedframe
