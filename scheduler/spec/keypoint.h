// A named point of an asset.
#pragma once

#include <Eigen/Core>
#include <string>

namespace seedframe {

struct Keypoint {
  std::string name;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< object space
  bool inside = false;  ///< within the mesh, such as a joint: its own surface does not hide it
};

}  // namespace seedframe
