// Lamps as shading knows them: light from a point or a direction, and a size that softens shadows.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "rays/ray_scene.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// So many places of a lamp are tried for its shadow, each from another point of the surface. The
/// first four are the outermost.
inline constexpr std::size_t kLampPlaces = 16;

class Lamp {
 public:
  explicit Lamp(const LightSpec& light);

  /// The light of a watt of it (of a sun: a watt per square metre) that a surface receives, in
  /// W/m², if nothing is in between: all of it from the lamp's middle.
  double irradiance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
  /// Watts, RGB.
  const Eigen::Vector3d& power() const { return power_; }
  /// From a point of a surface to one of the places.
  LightRay ray_from(const Eigen::Vector3d& point, std::size_t place) const;
  /// Whether its shadows have soft edges.
  bool has_size() const;

 private:
  LightKind kind_;
  Eigen::Vector3d place_;
  Eigen::Matrix3d axes_;  ///< its x, y and z (backwards), of unit length
  Eigen::Vector3d power_;
  double cone_edge_, cone_blend_;    ///< cosine at the edge, and how much it is blurred
  std::array<double, 2> half_size_;  ///< metres along x and y; of a sun as seen from 1 m
};

/// Evenly over a disc of radius 1, the innermost first (Vogel's spiral).
const std::array<std::array<double, 2>, kLampPlaces>& disc_points();

}  // namespace seedframe
