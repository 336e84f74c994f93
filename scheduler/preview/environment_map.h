// The light that comes from all around, out of an environment map.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "image/image.h"

namespace seedframe {

/// Light of all directions as nine spherical harmonics hold it: enough for a matt surface, whose
/// irradiance they have within 3 % for most maps (Ramamoorthi and Hanrahan, "An Efficient
/// Representation for Irradiance Environment Maps", 2001).
class AmbientLight {
 public:
  /// The same from everywhere.
  static AmbientLight even(const Eigen::Vector3f& radiance);
  /// Of an equirectangular map; see EnvironmentMap.
  static AmbientLight of_map(const Image<float>& map);

  /// Of a surface that faces `normal`; not negative.
  Eigen::Vector3f irradiance(const Eigen::Vector3f& normal) const;
  /// From `direction`, as smooth as nine harmonics are; not negative.
  Eigen::Vector3f radiance(const Eigen::Vector3f& direction) const;

 private:
  Eigen::Vector3f sum(const std::array<float, 3>& band_weights,
                      const Eigen::Vector3f& direction) const;

  std::array<Eigen::Vector3f, 9> coefficients_{};  ///< of radiance
};

/// Equirectangular as Blender has it: +x in the middle, +y a quarter left of it, z up.
class EnvironmentMap {
 public:
  /// RGB, linear, at least one pixel.
  explicit EnvironmentMap(Image<float> light);

  /// From a direction (of any length) of the map's own frame, bilinear.
  Eigen::Vector3f radiance(const Eigen::Vector3f& direction) const;
  /// All of it, in the map's own frame.
  const AmbientLight& ambient() const { return ambient_; }
  std::size_t bytes() const { return sizeof *this + map_.values.size() * sizeof(float); }

 private:
  Image<float> map_;
  AmbientLight ambient_;
};

}  // namespace seedframe
