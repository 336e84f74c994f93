// Things that fall onto each other.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "mesh/mesh.h"

namespace seedframe {

struct Heaped {
  const Mesh* mesh = nullptr;
  Eigen::Affine3d world_from_object = Eigen::Affine3d::Identity();
  std::optional<double> falls;  ///< the less, the earlier; none: it stays where it is, before all
};

/// By how much each must be raised (world z) so that it lies on what fell before it, and on what
/// stays: as if it came straight down from above until it touches something or is where it is now.
/// It keeps its rotation. What touches is found by HeightMap. Equal orders fall as they are listed.
std::vector<double> heaped_up(const std::vector<Heaped>& things);

}  // namespace seedframe
