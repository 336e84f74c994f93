#include "assets/uv_scale.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace seedframe {
namespace {

using Point = std::array<float, 3>;

Eigen::Vector3d vector(const Point& point) { return {point[0], point[1], point[2]}; }

/// Twice the triangle's area, along its normal.
Eigen::Vector3d normal_of(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3d first = vector(mesh.positions[a]);
  return (vector(mesh.positions[b]) - first).cross(vector(mesh.positions[c]) - first);
}

double uv_area_of(const Mesh& mesh, std::size_t triangle) {
  const std::array<float, 2>* uv = &mesh.corner_uvs[3 * triangle];
  const double u1 = double{uv[1][0]} - uv[0][0], v1 = double{uv[1][1]} - uv[0][1];
  const double u2 = double{uv[2][0]} - uv[0][0], v2 = double{uv[2][1]} - uv[0][1];
  return std::abs(u1 * v2 - u2 * v1);
}

/// What an eye that looks against `normal` sees to its right, and above.
std::array<float, 2> seen(const Point& point, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d size = normal.cwiseAbs();
  if (size.z() >= std::max(size.x(), size.y())) {
    return {normal.z() >= 0.0 ? point[0] : -point[0], point[1]};
  }
  if (size.x() >= size.y()) return {normal.x() >= 0.0 ? point[1] : -point[1], point[2]};
  return {normal.y() >= 0.0 ? -point[0] : point[0], point[2]};
}

}  // namespace

bool has_uvs(const Mesh& mesh) {
  return std::any_of(mesh.corner_uvs.begin(), mesh.corner_uvs.end(),
                     [&](const std::array<float, 2>& uv) { return uv != mesh.corner_uvs[0]; });
}

void project_uvs(Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d normal = normal_of(mesh, t);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      mesh.corner_uvs[3 * t + corner] = seen(mesh.positions[mesh.triangles[t][corner]], normal);
    }
  }
}

double metres_per_uv(const Mesh& mesh) {
  double surface = 0.0, image = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    surface += normal_of(mesh, t).norm();
    image += uv_area_of(mesh, t);
  }
  const double ratio = surface / image;
  return std::isfinite(ratio) && ratio > 0.0 ? std::sqrt(ratio) : 1.0;
}

}  // namespace seedframe
