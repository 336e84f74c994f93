// The points of surfaces that an image shows, and means over neighbours on the same surface.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "rays/ray_scene.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// Some pixels of an image, in rows and columns of their own.
struct PixelGrid {
  int width = 0;
  int height = 0;
  std::vector<std::int32_t> pixels;  ///< row by row; -1 where no surface is seen

  std::int32_t at(int row, int column) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(column)];
  }
};

/// The four points of SeenPoints::one_of_four around a pixel of the image.
std::array<std::int32_t, 4> points_around(const PixelGrid& one_of_four, int row, int column);

/// Samples that differ over 4 × 4 neighbours of a grid, and are made one by their mean: each has a
/// number from 0 to 15, and near ones have far numbers. Those of even rows and columns have the
/// first four.
inline constexpr std::size_t kSamplesOfMean = 16;
std::size_t sample_number(int row, int column);

class SeenPoints {
 public:
  /// `rays` were traced with depth and normals, and must outlive it.
  SeenPoints(const RayImage& rays, const CameraSpec& camera);

  const RayImage& rays() const { return rays_; }
  /// In the camera's frame, metres.
  const Eigen::Vector3f& position(std::int32_t pixel) const {
    return positions_[static_cast<std::size_t>(pixel)];
  }
  /// Just above the surface, where rays of light may begin.
  Eigen::Vector3d above(std::int32_t pixel) const;
  Eigen::Vector3f normal(std::int32_t pixel) const {
    return Eigen::Map<const Eigen::Vector3f>(rays_.normals[static_cast<std::size_t>(pixel)].data());
  }
  float pixel_width_m(std::int32_t pixel) const {
    return per_focal_ * rays_.depth[static_cast<std::size_t>(pixel)];
  }

  PixelGrid all_pixels() const;
  /// Of each 2 × 2 pixels the first that shows a surface.
  PixelGrid one_of_four() const;

  /// Each of the values (`channels` at each point of the grid) becomes the mean over those of 4 × 4
  /// points that are on the same surface: itself, one before and two behind, or the other way
  /// round.
  enum class Reach { kOneBefore, kTwoBefore };
  void smooth(const PixelGrid& grid, std::vector<float>& values, int channels,
              Reach reach = Reach::kOneBefore) const;
  /// Whether all of points_around a pixel are on its own surface.
  bool on_surface_around(const PixelGrid& one_of_four, int row, int column) const;
  /// For every pixel of a surface the nearest point of one_of_four() that is on the same surface;
  /// else the one of its own four.
  std::vector<std::int32_t> points_for_pixels(const PixelGrid& one_of_four) const;

 private:
  bool on_same_surface(std::int32_t a, std::int32_t b) const;

  const RayImage& rays_;
  float per_focal_;
  std::vector<Eigen::Vector3f> positions_;  ///< by pixel
};

}  // namespace seedframe
