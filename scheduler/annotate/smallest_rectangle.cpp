#include "annotate/smallest_rectangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/convex_hull_2.h>

namespace seedframe {
namespace {

constexpr double kPi = 3.14159265358979323846;

using Kernel = CGAL::Simple_cartesian<std::int64_t>;  // exact: pixels are whole numbers
using Point = Kernel::Point_2;

/// Corners of the first and the last pixel of every row.
std::vector<Point> outermost_corners(const Mask& mask) {
  const PixelRect& box = mask.box();
  std::vector<Point> corners;
  corners.reserve(static_cast<std::size_t>(box.height) * 4);
  for (int row = box.y; row < box.end_y(); ++row) {
    int first = box.x;
    int last = box.end_x() - 1;
    while (first <= last && !mask.at(row, first)) ++first;
    while (last >= first && !mask.at(row, last)) --last;
    if (first > last) continue;
    for (const int y : {row, row + 1}) {
      corners.emplace_back(first, y);
      corners.emplace_back(last + 1, y);
    }
  }
  return corners;
}

/// Begins at the point of least y and, among these, least x: of rectangles of the same area the
/// first counts.
std::vector<Point> convex_hull(const std::vector<Point>& points) {
  std::vector<Point> hull;
  CGAL::convex_hull_2(points.begin(), points.end(), std::back_inserter(hull), Kernel());
  const auto first = std::min_element(hull.begin(), hull.end(), Kernel::Less_yx_2());
  std::rotate(hull.begin(), first, hull.end());
  return hull;
}

struct Rectangle {
  double area = std::numeric_limits<double>::infinity();
  std::array<std::array<double, 2>, 4> corners{};
  bool in_image = true;
};

/// The rectangle around the hull with a side along (dx, dy). Whole numbers tell whether its corners
/// are in the image: one that lies on its edge is.
Rectangle rectangle_along(const std::vector<Point>& hull, std::int64_t dx, std::int64_t dy,
                          const Mask& mask) {
  std::array<std::int64_t, 2> low = {std::numeric_limits<std::int64_t>::max(),
                                     std::numeric_limits<std::int64_t>::max()};
  std::array<std::int64_t, 2> high = {std::numeric_limits<std::int64_t>::min(),
                                      std::numeric_limits<std::int64_t>::min()};
  for (const Point& point : hull) {
    const std::array<std::int64_t, 2> at = {point.x() * dx + point.y() * dy,
                                            point.y() * dx - point.x() * dy};
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], at[i]);
      high[i] = std::max(high[i], at[i]);
    }
  }
  const std::int64_t whole_squared = dx * dx + dy * dy;
  const auto squared = static_cast<double>(whole_squared);
  Rectangle candidate;
  candidate.area =
      static_cast<double>(high[0] - low[0]) * static_cast<double>(high[1] - low[1]) / squared;
  const std::array<std::array<std::int64_t, 2>, 4> ends = {
      {{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}}};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto [u, v] = ends[i];
    const std::int64_t x = u * dx - v * dy;
    const std::int64_t y = u * dy + v * dx;
    candidate.corners[i] = {static_cast<double>(x) / squared, static_cast<double>(y) / squared};
    candidate.in_image = candidate.in_image && x >= 0 && y >= 0 &&
                         x <= mask.image_width() * whole_squared &&
                         y <= mask.image_height() * whole_squared;
  }
  return candidate;
}

/// Where a hull touches the four sides of a rectangle whose first side runs at an angle.
struct Supports {
  Point low_u, high_u, low_v, high_v;
};

Supports supports_at(const std::vector<Point>& hull, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Supports found{hull[0], hull[0], hull[0], hull[0]};
  const auto u = [&](const Point& p) {
    return static_cast<double>(p.x()) * c + static_cast<double>(p.y()) * s;
  };
  const auto v = [&](const Point& p) {
    return static_cast<double>(p.y()) * c - static_cast<double>(p.x()) * s;
  };
  for (const Point& point : hull) {
    if (u(point) < u(found.low_u)) found.low_u = point;
    if (u(point) > u(found.high_u)) found.high_u = point;
    if (v(point) < v(found.low_v)) found.low_v = point;
    if (v(point) > v(found.high_v)) found.high_v = point;
  }
  return found;
}

/// A corner between a side through p along the rectangle's v and one through q along its u moves on
/// the circle over p and q: x = x0 + x1 cos 2a + x2 sin 2a, and y likewise.
struct Corner {
  std::array<double, 2> middle, cosine, sine;

  Corner(const Point& p, const Point& q)
      : middle{static_cast<double>(p.x() + q.x()) / 2, static_cast<double>(p.y() + q.y()) / 2},
        cosine{static_cast<double>(p.x() - q.x()) / 2, -static_cast<double>(p.y() - q.y()) / 2},
        sine{static_cast<double>(p.y() - q.y()) / 2, static_cast<double>(p.x() - q.x()) / 2} {}

  std::array<double, 2> at(double angle) const {
    const double c = std::cos(2 * angle);
    const double s = std::sin(2 * angle);
    return {middle[0] + cosine[0] * c + sine[0] * s, middle[1] + cosine[1] * c + sine[1] * s};
  }
  /// Angles at which a coordinate has a value, in the half turn from `from` on.
  void add_angles(std::size_t axis, double value, double from, std::vector<double>& angles) const {
    const double radius = std::hypot(cosine[axis], sine[axis]);
    const double share = radius > 0.0 ? (value - middle[axis]) / radius : 2.0;
    if (std::abs(share) > 1.0) return;
    const double phase = std::atan2(sine[axis], cosine[axis]);
    for (const double side : {-1.0, 1.0}) {
      const double angle = (phase + side * std::acos(share)) / 2;
      angles.push_back(angle - std::floor((angle - from) / kPi) * kPi);
    }
  }
};

/// Where the image cuts off rectangles, the smallest that it leaves stands on a side of the hull,
/// or has a corner on the edge of the image: all of these are tried.
Rectangle smallest_in_image(const std::vector<Point>& hull, const Mask& mask) {
  const std::array<double, 2> size = {static_cast<double>(mask.image_width()),
                                      static_cast<double>(mask.image_height())};
  std::vector<double> turns;  // of the hull's sides, within a quarter
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point& from = hull[i];
    const Point& to = hull[i + 1 < hull.size() ? i + 1 : 0];
    const double angle =
        std::atan2(static_cast<double>(to.y() - from.y()), static_cast<double>(to.x() - from.x()));
    turns.push_back(angle - std::floor(angle / (kPi / 2)) * (kPi / 2));
  }
  std::sort(turns.begin(), turns.end());
  turns.push_back(turns.front() + kPi / 2);
  Rectangle best = rectangle_along(hull, 1, 0, mask);
  for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
    const Supports on = supports_at(hull, (turns[i] + turns[i + 1]) / 2);
    const std::array<Corner, 4> corners = {Corner(on.low_u, on.low_v), Corner(on.high_u, on.low_v),
                                           Corner(on.high_u, on.high_v),
                                           Corner(on.low_u, on.high_v)};
    std::vector<double> angles = {turns[i], turns[i + 1]};
    for (const Corner& corner : corners) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        corner.add_angles(axis, 0.0, turns[i], angles);
        corner.add_angles(axis, size[axis], turns[i], angles);
      }
    }
    for (const double angle : angles) {
      if (angle > turns[i + 1]) continue;
      Rectangle candidate;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        candidate.corners[k] = corners[k].at(angle);
        for (std::size_t axis = 0; axis < 2; ++axis) {
          double& value = candidate.corners[k][axis];
          constexpr double kRounding = 1e-9;
          candidate.in_image =
              candidate.in_image && value >= -kRounding && value <= size[axis] + kRounding;
          value = std::clamp(value, 0.0, size[axis]);
        }
      }
      const auto side = [&](std::size_t a, std::size_t b) {
        return std::hypot(candidate.corners[a][0] - candidate.corners[b][0],
                          candidate.corners[a][1] - candidate.corners[b][1]);
      };
      candidate.area = side(0, 1) * side(1, 2);
      if (candidate.in_image && candidate.area < best.area) best = candidate;
    }
  }
  return best;
}

}  // namespace

OrientedBox smallest_rectangle(const Mask& mask) {
  const std::vector<Point> hull = convex_hull(outermost_corners(mask));
  Rectangle best = rectangle_along(hull, 1, 0, mask);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point& from = hull[i];
    const Point& to = hull[i + 1 < hull.size() ? i + 1 : 0];
    const Rectangle candidate = rectangle_along(hull, to.x() - from.x(), to.y() - from.y(), mask);
    if (candidate.area < best.area) best = candidate;
  }
  if (best.in_image) return {best.corners, true};
  return {smallest_in_image(hull, mask).corners, false};
}

}  // namespace seedframe
