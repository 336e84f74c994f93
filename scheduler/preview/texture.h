// A colour texture at every distance: the image, and halves of halves of it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/image.h"

namespace seedframe {

/// Repeats in both directions, as Blender's image textures do here. Colours have 8 bits.
class Texture {
 public:
  /// RGB, linear, at least one pixel.
  explicit Texture(Image<float> light);

  /// Linear RGB where u goes right and v up, 1 being the whole image. `width`, in the same unit, is
  /// of what is averaged: bilinear in each of two levels, and between them.
  Eigen::Vector3f color(double u, double v, double width) const;
  const Eigen::Vector3f& mean() const { return mean_; }
  std::size_t bytes() const;

 private:
  Eigen::Vector3f in_level(std::size_t level, double u, double v) const;

  std::vector<Image<std::uint8_t>> levels_;  ///< sRGB, largest first
  Eigen::Vector3f mean_ = Eigen::Vector3f::Zero();
};

}  // namespace seedframe
