// Nearest points of triangles and segments.
#pragma once

#include <Eigen/Core>

namespace seedframe {

/// Weights of a, b and c, from 0 to 1 with a sum of 1, for the point of the triangle that is
/// nearest to p (Ericson, "Real-Time Collision Detection", 2005, section 5.1.5). The triangle may
/// be a segment or a point.
Eigen::Vector3d nearest_weights(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b, const Eigen::Vector3d& c);

double squared_distance_to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c);

double squared_distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b);

}  // namespace seedframe
