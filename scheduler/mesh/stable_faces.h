// On which faces of its convex hull an object can stand.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

struct StableFace {
  Eigen::Vector3d normal;    ///< outward, of unit length, in the scaled object space
  double probability = 0.0;  ///< of all faces together: 1
};

/// Of an object of even density that falls in any attitude, likeliest first. Of the faces of its
/// hull each catches the solid angle that it takes up from the centre of mass. It tips on from one
/// that the centre does not stand above by 3 degrees or more, over the edge that the centre is
/// farthest beyond, if the centre sinks by that; a cylinder rests on any line of its side
/// (K. Goldberg et al., "Part pose statistics: estimators and experiments", IEEE Transactions on
/// Robotics and Automation 15, 1999). Faces that deviate from a plane by less than 1/10,000 of the
/// object's size are one. The mesh must pass check_mesh; one without a volume is an error (kInput).
Result<std::vector<StableFace>> stable_faces(const Mesh& mesh, const Eigen::Vector3d& scale);

/// The least rotation that turns a face's normal downwards, to -z.
Eigen::Matrix3d standing_on(const StableFace& face);

}  // namespace seedframe
