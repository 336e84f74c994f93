// What a mesh is like, in numbers for people and for checks.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "mesh/mesh.h"

namespace seedframe {

struct MeshMeasures {
  BoundingBox box;
  double size_m = 0.0;  ///< the longest side of the box: what errors are shares of
  double area_m2 = 0.0;
  std::size_t boundary_edges = 0;   ///< with one triangle
  std::size_t bad_edges = 0;        ///< with more than two, or two that run the same way
  bool watertight = false;          ///< neither kind
  std::size_t parts = 0;            ///< connected by edges
  std::optional<double> volume_m3;  ///< of a watertight mesh; parts that overlap count twice
  std::optional<long> genus;        ///< of a watertight mesh: holes through it, over all its parts
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< of the surface
  /// Columns: the axes about which the surface's second moment is greatest, middle and least
  /// (weighted by area, so that open and overlapping meshes have them too), right-handed.
  Eigen::Matrix3d principal_axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d principal_size_m = Eigen::Vector3d::Zero();  ///< the mesh's extent along each
};

/// The mesh must pass check_mesh.
MeshMeasures measure_mesh(const Mesh& mesh);

}  // namespace seedframe
