// Where things are in the world, and how the camera sees them. Metres; the world has x right, y
// away, z up.
#pragma once

#include <array>
#include <vector>

#include "spec/frame_spec.h"

namespace seedframe {

/// Scaled along the object's own axes, then turned about x, then y, then z (Blender's XYZ Euler
/// order): R_z · R_y · R_x · diag(scale).
Eigen::Matrix3d rotation_and_scale(const Eigen::Vector3d& rotation_deg,
                                   const Eigen::Vector3d& scale);

/// Of a quaternion w + xi + yj + zk, whatever its length, which is above 0.
Eigen::Matrix3d rotation_of_quaternion(const std::array<double, 4>& wxyz);

/// Evenly spread over all rotations, if three numbers are over [0, 1]: K. Shoemake, "Uniform random
/// rotations", Graphics Gems III, 1992.
std::array<double, 4> random_quaternion(const std::array<double, 3>& uniform);

/// World from a frame that looks from `position` at `target` down its -z, with its y as near to up
/// as can be; looking straight up or down, y points away (world y). Turned by roll_deg about the
/// viewing axis, counter-clockwise as the viewer sees the camera turn.
Affine looking_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target, double roll_deg);

/// The place on a sphere around the target: azimuth 0 looks along world y, growing
/// counter-clockwise seen from above; elevation 90 looks straight down.
Eigen::Vector3d on_shell(const Eigen::Vector3d& target, double distance_m, double azimuth_deg,
                         double elevation_deg);

/// Puts an object down: lifted by how far it reaches below its origin (lowest_z, at most 0 as a
/// rule), and on a ground z = curvature · (x² + y²) / 2 standing upright on the slope under its
/// origin.
Affine resting(const Affine& parent_from_object, double lowest_z, double curvature_per_m);

/// Bounding circle of an object's shadow on the ground.
struct Footprint {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
};

/// About the object's origin, of a box [low, high] in object space under a linear map.
double footprint_radius(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                        const Eigen::Matrix3d& linear);

/// True if a circle keeps `gap` from all others.
bool is_clear(const Footprint& circle, const std::vector<Footprint>& others, double gap);

/// camera_from_world · world_from_object in double, subtracting the camera's position first: so
/// nothing is lost far from the world's origin.
Affine relative_to_camera(const Affine& world_from_camera, const Affine& world_from_object);

}  // namespace seedframe
