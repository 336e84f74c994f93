#include "annotate/smallest_rectangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace seedframe {
namespace {

struct Point {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

std::int64_t turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Corners of the first and the last pixel of every row, by y, then x.
std::vector<Point> outermost_corners(const Mask& mask) {
  const PixelBox& box = mask.box();
  std::vector<Point> corners;
  corners.reserve(static_cast<std::size_t>(box.height) * 4);
  for (int row = box.y; row < box.y + box.height; ++row) {
    int first = box.x;
    int last = box.x + box.width - 1;
    while (first <= last && !mask.at(row, first)) ++first;
    while (last >= first && !mask.at(row, last)) --last;
    if (first > last) continue;
    for (const int y : {row, row + 1}) {
      corners.push_back({first, y});
      corners.push_back({last + 1, y});
    }
  }
  std::sort(corners.begin(), corners.end(),
            [](const Point& a, const Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return corners;
}

/// Andrew's monotone chain (1979), without points on straight lines.
std::vector<Point> convex_hull(const std::vector<Point>& points) {
  std::vector<Point> hull;
  const auto add = [&hull](const Point& point, std::size_t least) {
    while (hull.size() >= least + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) {
      hull.pop_back();
    }
    hull.push_back(point);
  };
  for (const Point& point : points) add(point, 0);
  const std::size_t half = hull.size() - 1;
  for (auto point = points.rbegin(); point != points.rend(); ++point) add(*point, half);
  hull.pop_back();  // the first again
  return hull;
}

struct Candidate {
  double area = std::numeric_limits<double>::infinity();
  std::array<std::array<double, 2>, 4> corners{};
};

/// The rectangle around the hull with a side along (dx, dy).
Candidate rectangle_along(const std::vector<Point>& hull, std::int64_t dx, std::int64_t dy) {
  std::array<std::int64_t, 2> low = {std::numeric_limits<std::int64_t>::max(),
                                     std::numeric_limits<std::int64_t>::max()};
  std::array<std::int64_t, 2> high = {std::numeric_limits<std::int64_t>::min(),
                                      std::numeric_limits<std::int64_t>::min()};
  for (const Point& point : hull) {
    const std::array<std::int64_t, 2> at = {point.x * dx + point.y * dy,
                                            point.y * dx - point.x * dy};
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], at[i]);
      high[i] = std::max(high[i], at[i]);
    }
  }
  const auto squared = static_cast<double>(dx * dx + dy * dy);
  Candidate candidate;
  candidate.area =
      static_cast<double>(high[0] - low[0]) * static_cast<double>(high[1] - low[1]) / squared;
  const std::array<std::array<std::int64_t, 2>, 4> ends = {
      {{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}}};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto [u, v] = ends[i];
    candidate.corners[i] = {static_cast<double>(u * dx - v * dy) / squared,
                            static_cast<double>(u * dy + v * dx) / squared};
  }
  return candidate;
}

bool is_in_image(const Candidate& candidate, const Mask& mask) {
  return std::all_of(candidate.corners.begin(), candidate.corners.end(), [&](const auto& corner) {
    return corner[0] >= 0.0 && corner[0] <= mask.image_width() && corner[1] >= 0.0 &&
           corner[1] <= mask.image_height();
  });
}

}  // namespace

OrientedBox smallest_rectangle(const Mask& mask) {
  const std::vector<Point> hull = convex_hull(outermost_corners(mask));
  Candidate best = rectangle_along(hull, 1, 0);
  double least = best.area;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point& from = hull[i];
    const Point& to = hull[i + 1 < hull.size() ? i + 1 : 0];
    const Candidate candidate = rectangle_along(hull, to.x - from.x, to.y - from.y);
    least = std::min(least, candidate.area);
    if (candidate.area < best.area && is_in_image(candidate, mask)) best = candidate;
  }
  return {best.corners, !(least < best.area)};
}

}  // namespace seedframe
