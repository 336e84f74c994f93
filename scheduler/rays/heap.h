// Things that fall onto each other.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/mesh.h"

namespace seedframe {

struct Heaped {
  const Mesh* mesh = nullptr;  ///< null: nothing lies on it
  Eigen::Affine3d world_from_object = Eigen::Affine3d::Identity();
  std::optional<double> falls = {};        ///< the less, the earlier; none: it stays, before all
  std::shared_ptr<const void> owner = {};  ///< of the mesh, which stays as it is
};

/// By how much each must be raised (world z) so that it lies on what fell before it, and on what
/// stays: as if it came straight down from above until it touches something or is where it is now.
/// It keeps its rotation. The last heap of each thread is remembered, since the views of a scene
/// have the same one, mostly; its owners stay until then. What touches is found by HeightMap. Equal
/// orders fall as they are listed.
std::vector<double> heaped_up(const std::vector<Heaped>& things);

}  // namespace seedframe
