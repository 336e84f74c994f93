// What pycocotools makes of an annotation, written for the tests from the format's description and
// sharing nothing with the encoder.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace seedframe::coco_decoder {

using Bitmap = Image<std::uint8_t>;

/// Runs of a compressed string: little-endian groups of five bits, 0x20 continues, 0x10 of the last
/// group is the sign; runs after the third are differences to the run two before.
inline std::vector<std::int64_t> runs_of_string(std::string_view text) {
  std::vector<std::int64_t> runs;
  std::int64_t value = 0;
  int shift = 0;
  for (const char letter : text) {
    const int group = letter - 48;
    value += static_cast<std::int64_t>(group & 31) * (std::int64_t{1} << shift);
    shift += 5;
    if ((group & 32) != 0) continue;
    if ((group & 16) != 0) value -= std::int64_t{1} << shift;
    if (runs.size() > 2) value += runs[runs.size() - 2];
    runs.push_back(value);
    value = 0;
    shift = 0;
  }
  return runs;
}

/// Column by column, background first. Runs that do not add up leave a bitmap without pixels.
inline Bitmap bitmap_of_runs(const std::vector<std::int64_t>& runs, int height, int width) {
  Bitmap bitmap(width, height);
  std::int64_t position = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::int64_t k = 0; k < runs[i]; ++k, ++position) {
      if (position >= std::int64_t{height} * width) return {};
      bitmap.at(static_cast<int>(position % height), static_cast<int>(position / height)) = i % 2;
    }
  }
  return position == std::int64_t{height} * width ? bitmap : Bitmap{};
}

/// Polygons are drawn on a grid five times finer. Each edge becomes one grid point a step of its
/// longer axis. Wherever two neighbouring points of the outline lie left and right of a pixel
/// column's middle, the pixels of that column from there downwards change between out and in.
class PolygonRasteriser {
 public:
  PolygonRasteriser(int height, int width)
      : height_(height),
        width_(width),
        flips_(static_cast<std::size_t>(height) * static_cast<std::size_t>(width) + 1, false) {}

  /// xy: x0, y0, x1, y1, … in pixels.
  void add(const std::vector<double>& xy) {
    const std::size_t count = xy.size() / 2;
    const auto grid = [&xy](std::size_t i) { return static_cast<int>(5.0 * xy[i] + 0.5); };
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t next = (i + 1) % count;
      walk({grid(2 * i), grid(2 * i + 1)}, {grid(2 * next), grid(2 * next + 1)});
    }
  }

  Bitmap bitmap() const {
    Bitmap result(width_, height_);
    bool inside = false;
    for (int column = 0; column < width_; ++column) {
      for (int row = 0; row < height_; ++row) {
        inside ^= flips_[index(column, row)];
        result.at(row, column) = inside;
      }
    }
    return result;
  }

 private:
  struct Point {
    int x;
    int y;
  };

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(column) * static_cast<std::size_t>(height_) +
           static_cast<std::size_t>(row);
  }

  /// Crossings do not depend on the direction of an edge, so it is walked towards the larger
  /// coordinate of its longer axis.
  void walk(Point a, Point b) {
    const bool flat = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
    if (flat ? a.x > b.x : a.y > b.y) std::swap(a, b);
    const int steps = flat ? b.x - a.x : b.y - a.y;
    const double slope =
        steps == 0 ? 0.0 : static_cast<double>(flat ? b.y - a.y : b.x - a.x) / steps;
    Point last = a;
    for (int i = 1; i <= steps; ++i) {
      Point here;
      if (flat) {
        here = {a.x + i, static_cast<int>(a.y + slope * i + 0.5)};
      } else {
        here = {static_cast<int>(a.x + slope * i + 0.5), a.y + i};
      }
      if (here.x != last.x) cross(std::min(here.x, last.x), std::min(here.y, last.y));
      last = here;
    }
  }

  /// Between grid columns left and left + 1; grid point g lies at (g + 1/2) / 5 - 1/2 in pixels.
  void cross(int left, int upper) {
    if (left % 5 != 2) return;
    const int column = left / 5;
    if (left < 0 || column > width_ - 1) return;
    const double y = std::clamp((upper + 0.5) / 5.0 - 0.5, 0.0, static_cast<double>(height_));
    const std::size_t flip = index(column, static_cast<int>(std::ceil(y)));
    flips_[flip] = !flips_[flip];
  }

  int height_;
  int width_;
  std::vector<bool> flips_;
};

/// An annotation's polygons are united.
inline Bitmap bitmap_of_polygons(const std::vector<std::vector<double>>& polygons, int height,
                                 int width) {
  Bitmap united(width, height);
  for (const std::vector<double>& polygon : polygons) {
    PolygonRasteriser rasteriser(height, width);
    rasteriser.add(polygon);
    const Bitmap bitmap = rasteriser.bitmap();
    for (std::size_t i = 0; i < united.values.size(); ++i) united.values[i] |= bitmap.values[i];
  }
  return united;
}

}  // namespace seedframe::coco_decoder
