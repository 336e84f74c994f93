// The pinhole through whose pixels' centres rays go.
#pragma once

#include <array>
#include <vector>

#include "base/pixel_rect.h"

namespace seedframe {

/// A pinhole at the origin that looks down -z with y up; pixel centres are whole numbers, y down.
struct PixelCamera {
  int width = 0;
  int height = 0;
  std::array<double, 2> focal_px{};
  std::array<double, 2> center_px{};
  double clip_start_m = 0.0;
  double clip_end_m = 0.0;
  /// Depth at which rays begin, and from which they are measured in float32: no surface is nearer.
  double ray_start_m = 0.0;

  /// Directions of rays, whose z is -1: x of a column's, y of a row's.
  float ray_x(int column) const {
    return static_cast<float>((column - center_px[0]) / focal_px[0]);
  }
  float ray_y(int row) const { return static_cast<float>((center_px[1] - row) / focal_px[1]); }
};

/// The image and as much again on every side: where silhouettes are looked for.
PixelRect enlarged_canvas(const PixelCamera& camera);

/// The directions of all rays of the enlarged canvas.
class PixelRays {
 public:
  explicit PixelRays(const PixelCamera& camera);

  float x(int column) const { return x_[static_cast<std::size_t>(column - canvas_.x)]; }
  float y(int row) const { return y_[static_cast<std::size_t>(row - canvas_.y)]; }

 private:
  PixelRect canvas_;
  std::vector<float> x_;
  std::vector<float> y_;
};

}  // namespace seedframe
