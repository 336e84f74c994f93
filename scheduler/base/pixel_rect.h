// A rectangle of pixels: boxes of masks, silhouettes, regions.
#pragma once

#include <cstdint>

namespace seedframe {

/// Columns [x, end_x()) of rows [y, end_y()), counted from the image's upper left pixel; it may
/// reach beyond the image. Pixel (0, 0) alone is {0, 0, 1, 1}.
struct PixelRect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  int end_x() const { return x + width; }
  int end_y() const { return y + height; }
  bool empty() const { return width <= 0 || height <= 0; }
  std::int64_t area() const { return std::int64_t{width} * height; }
  bool contains(int column, int row) const {
    return column >= x && column < end_x() && row >= y && row < end_y();
  }
  bool operator==(const PixelRect&) const = default;
};

/// The smallest rectangle that holds both; an empty one holds nothing.
PixelRect union_of(const PixelRect& a, const PixelRect& b);

}  // namespace seedframe
