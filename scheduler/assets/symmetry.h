// Rotations after which a part looks as before.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/mesh.h"

namespace seedframe {

struct Symmetries {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< every axis goes through it, metres
  std::vector<Eigen::Vector3d> axes;                 ///< unit vectors about which any angle is one
  /// The others but for the identity: a whole group, or, with an axis, what turns that over.
  std::vector<Eigen::Matrix3d> rotations;
};

/// By shape alone: rotations about the centroid of the surface after which no sampled point of it
/// (vertices and centres of triangles, 4,000 at most) is further than `tolerance_m` from it. Tried
/// are the asset's own axes and the principal ones, with all orders up to 36; what follows from
/// those that are found is not tried again. A group of more than 120 rotations is left out.
Symmetries find_symmetries(const Mesh& mesh, double tolerance_m);

}  // namespace seedframe
