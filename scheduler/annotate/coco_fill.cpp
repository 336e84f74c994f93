#include "annotate/coco_fill.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace seedframe {
namespace {

// An outline is drawn on a grid this much finer than the pixels, a point for each step of the
// longer axis of an edge. Where it goes from one side of a column of pixel centres to the other,
// the pixels from there downwards change between outside and inside.
constexpr int kFiner = 5;

struct GridPoint {
  int x = 0;
  int y = 0;
};

GridPoint grid_point(const Vertex& vertex, const PixelRect& box) {
  const auto scaled = [](std::int32_t hundredths, int begin) {
    return (kFiner * (hundredths - begin * kVerticesPerPixel) + kVerticesPerPixel / 2) /
           kVerticesPerPixel;
  };
  return {scaled(vertex.x, box.x), scaled(vertex.y, box.y)};
}

void append_edge(const GridPoint& from, const GridPoint& to, std::vector<GridPoint>& outline) {
  const int dx = std::abs(to.x - from.x);
  const int dy = std::abs(to.y - from.y);
  const bool flat = dx >= dy;
  // Always stepped upwards along the longer axis, so that an edge is the same both ways.
  const bool backwards = flat ? from.x > to.x : from.y > to.y;
  const GridPoint& low = backwards ? to : from;
  const GridPoint& high = backwards ? from : to;
  const int steps = std::max(dx, dy);
  const double slope = steps == 0 ? 0.0
                       : flat     ? static_cast<double>(high.y - low.y) / dx
                                  : static_cast<double>(high.x - low.x) / dy;
  constexpr double kHalf = 0.5;
  for (int step = 0; step <= steps; ++step) {
    const int t = backwards ? steps - step : step;
    if (flat) {
      outline.push_back({low.x + t, static_cast<int>(low.y + slope * t + kHalf)});
    } else {
      outline.push_back({static_cast<int>(low.x + slope * t + kHalf), low.y + t});
    }
  }
}

/// For every pixel of the box, column by column, whether its column changes there.
std::vector<std::uint8_t> changes_of(const Polygon& polygon, const PixelRect& box) {
  std::vector<GridPoint> outline;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    append_edge(grid_point(polygon[i], box), grid_point(polygon[(i + 1) % polygon.size()], box),
                outline);
  }
  const auto height = static_cast<std::size_t>(box.height) + 1;  // a change below the last is none
  std::vector<std::uint8_t> changes(static_cast<std::size_t>(box.width) * height, 0);
  for (std::size_t i = 1; i < outline.size(); ++i) {
    const GridPoint& before = outline[i - 1];
    const GridPoint& here = outline[i];
    if (here.x == before.x) continue;
    const int left = std::min(here.x, before.x);
    // The middle of pixel column c is at 5c + 2 of the grid.
    if (left < 0 || left % kFiner != kFiner / 2 || left / kFiner >= box.width) continue;
    const int upper = std::min(here.y, before.y);
    const double row = (upper + 0.5) / kFiner - 0.5;
    const auto first =
        static_cast<std::size_t>(std::ceil(std::clamp(row, 0.0, static_cast<double>(box.height))));
    changes[static_cast<std::size_t>(left / kFiner) * height + first] ^= 1;
  }
  return changes;
}

}  // namespace

std::vector<std::uint8_t> coco_fill(const std::vector<Polygon>& polygons, const PixelRect& box) {
  const auto width = static_cast<std::size_t>(box.width);
  const auto height = static_cast<std::size_t>(box.height);
  std::vector<std::uint8_t> covered(width * height, 0);
  for (const Polygon& polygon : polygons) {
    const std::vector<std::uint8_t> changes = changes_of(polygon, box);
    for (std::size_t column = 0; column < width; ++column) {
      std::uint8_t inside = 0;
      for (std::size_t row = 0; row < height; ++row) {
        inside ^= changes[column * (height + 1) + row];
        covered[row * width + column] |= inside;
      }
    }
  }
  return covered;
}

}  // namespace seedframe
