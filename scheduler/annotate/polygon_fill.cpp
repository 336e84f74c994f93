#include "annotate/polygon_fill.h"

#include <algorithm>
#include <cassert>

#include "annotate/coco_fill.h"

namespace seedframe {
namespace {

constexpr std::int32_t kHalfPixel = kVerticesPerPixel / 2;

/// Where a polygon's edges cross the height of each row's centres, sorted.
std::vector<std::vector<double>> crossings(const Polygon& polygon, const PixelRect& box) {
  std::vector<std::vector<double>> rows(static_cast<std::size_t>(box.height));
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vertex& from = polygon[i];
    const Vertex& to = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    // From the upper end, so that a bridge gets the same numbers on the way back.
    const Vertex& upper = from.y < to.y ? from : to;
    const Vertex& lower = from.y < to.y ? to : from;
    const int first = std::max((upper.y + kHalfPixel - 1) / kVerticesPerPixel, box.y);
    const int last = std::min(lower.y / kVerticesPerPixel, box.end_y() - 1);
    for (int row = first; row <= last; ++row) {
      const std::int32_t y = row * kVerticesPerPixel + kHalfPixel;
      if (y < upper.y || y >= lower.y) continue;  // a vertex at this height counts once
      const double share = static_cast<double>(y - upper.y) / (lower.y - upper.y);
      rows[static_cast<std::size_t>(row - box.y)].push_back(upper.x + share * (lower.x - upper.x));
    }
  }
  for (auto& row : rows) std::sort(row.begin(), row.end());
  return rows;
}

}  // namespace

std::vector<std::uint8_t> fill_polygons(const std::vector<Polygon>& polygons,
                                        const PixelRect& box) {
  std::vector<std::uint8_t> covered(
      static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height), 0);
  for (const Polygon& polygon : polygons) {
    const auto rows = crossings(polygon, box);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      std::size_t next = 0;
      for (int column = 0; column < box.width; ++column) {
        const double centre = (box.x + column) * kVerticesPerPixel + kHalfPixel;
        while (next < rows[row].size() && rows[row][next] < centre) ++next;
        if (next % 2 == 1) {
          covered[row * static_cast<std::size_t>(box.width) + static_cast<std::size_t>(column)] = 1;
        }
      }
    }
  }
  return covered;
}

double polygon_iou(const std::vector<Polygon>& polygons, const Mask& mask, FillRule rule) {
  const PixelRect& box = mask.box();
  for (const Polygon& polygon : polygons) {
    for (const Vertex& vertex : polygon) {
      if (vertex.x < box.x * kVerticesPerPixel || vertex.y < box.y * kVerticesPerPixel ||
          vertex.x > box.end_x() * kVerticesPerPixel ||
          vertex.y > box.end_y() * kVerticesPerPixel) {
        return 0.0;
      }
    }
  }
  const std::vector<std::uint8_t> covered =
      rule == FillRule::kCoco ? coco_fill(polygons, box) : fill_polygons(polygons, box);
  std::int64_t both = 0;
  std::int64_t either = 0;
  auto pixel = covered.begin();
  for (int row = box.y; row < box.end_y(); ++row) {
    for (int column = box.x; column < box.end_x(); ++column, ++pixel) {
      const bool inside = mask.at(row, column);
      both += inside && *pixel != 0;
      either += inside || *pixel != 0;
    }
  }
  return either == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace seedframe
