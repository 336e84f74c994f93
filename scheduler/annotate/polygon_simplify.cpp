#include "annotate/polygon_simplify.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <utility>

#include "annotate/polygon_fill.h"

namespace seedframe {
namespace {

double squared_distance(const Vertex& a, const Vertex& b) {
  const double dx = static_cast<double>(a.x) - b.x;
  const double dy = static_cast<double>(a.y) - b.y;
  return dx * dx + dy * dy;
}

/// From a vertex to the segment between two others, squared.
double squared_distance(const Vertex& vertex, const Vertex& from, const Vertex& to) {
  const double length = squared_distance(from, to);
  if (length == 0.0) return squared_distance(vertex, from);
  const double dx = static_cast<double>(to.x) - from.x;
  const double dy = static_cast<double>(to.y) - from.y;
  const double along = ((static_cast<double>(vertex.x) - from.x) * dx +
                        (static_cast<double>(vertex.y) - from.y) * dy) /
                       length;
  if (along <= 0.0) return squared_distance(vertex, from);
  if (along >= 1.0) return squared_distance(vertex, to);
  const double across =
      (static_cast<double>(vertex.x) - from.x) * dy - (static_cast<double>(vertex.y) - from.y) * dx;
  return across * across / length;
}

/// Marks the vertices between the ends of an open chain that are kept.
void keep_chain(const Polygon& chain, std::size_t begin, std::size_t end, double tolerance,
                std::vector<bool>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open = {{begin, end}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double most = tolerance * tolerance;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = squared_distance(chain[i], chain[first], chain[last]);
      if (distance > most) {
        most = distance;
        farthest = i;
      }
    }
    if (farthest == first) continue;
    kept[farthest] = true;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
}

using Position = std::pair<std::int32_t, std::int32_t>;

/// Vertices that stand more than once in a polygon: the ends of bridges, which must stay together.
std::set<Position> fixed_positions(const Polygon& polygon) {
  std::set<Position> seen;
  std::set<Position> fixed;
  for (const Vertex& vertex : polygon) {
    if (!seen.insert({vertex.x, vertex.y}).second) fixed.insert({vertex.x, vertex.y});
  }
  return fixed;
}

/// A polygon's sides as the middles of their pixel edges, which lie on a smoother line than its
/// corners; bridges as they are. Without a bridge the first point is repeated at the end.
struct Outline {
  Polygon points;
  std::vector<std::size_t> fixed;  ///< indices of points; at least the first and the last
};

Outline outline_of(const Polygon& polygon) {
  const std::set<Position> fixed = fixed_positions(polygon);
  const auto is_fixed = [&](const Vertex& vertex) { return fixed.count({vertex.x, vertex.y}) > 0; };
  const auto first = std::find_if(polygon.begin(), polygon.end(), is_fixed);
  const auto begin = static_cast<std::size_t>(first == polygon.end() ? 0 : first - polygon.begin());
  Outline outline;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vertex& from = polygon[(begin + i) % polygon.size()];
    const Vertex& to = polygon[(begin + i + 1) % polygon.size()];
    if (is_fixed(from)) {
      outline.fixed.push_back(outline.points.size());
      outline.points.push_back(from);
    }
    if (is_fixed(from) && is_fixed(to)) continue;  // a bridge
    const int length = (std::abs(to.x - from.x) + std::abs(to.y - from.y)) / kVerticesPerPixel;
    for (int k = 0; k < length; ++k) {
      outline.points.push_back({from.x + (to.x - from.x) * (2 * k + 1) / (2 * length),
                                from.y + (to.y - from.y) * (2 * k + 1) / (2 * length)});
    }
  }
  if (outline.fixed.empty()) outline.fixed.push_back(0);
  outline.fixed.push_back(outline.points.size());
  outline.points.push_back(outline.points.front());
  return outline;
}

/// A closed chain is cut where it is farthest from its beginning, since a chain needs two ends.
void keep_closed_chain(const Polygon& chain, double tolerance, std::vector<bool>& kept) {
  std::size_t farthest = 0;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (squared_distance(chain[i], chain[0]) > squared_distance(chain[farthest], chain[0])) {
      farthest = i;
    }
  }
  kept[farthest] = true;
  keep_chain(chain, 0, farthest, tolerance, kept);
  keep_chain(chain, farthest, chain.size() - 1, tolerance, kept);
}

Polygon simplified(const Outline& outline, double tolerance) {
  const Polygon& points = outline.points;
  std::vector<bool> kept(points.size(), false);
  for (const std::size_t index : outline.fixed) kept[index] = true;
  if (outline.fixed.size() == 2) {
    keep_closed_chain(points, tolerance, kept);
  } else {
    for (std::size_t k = 0; k + 1 < outline.fixed.size(); ++k) {
      keep_chain(points, outline.fixed[k], outline.fixed[k + 1], tolerance, kept);
    }
  }
  Polygon out;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (kept[i]) out.push_back(points[i]);
  }
  return out;
}

}  // namespace

std::vector<Polygon> simplified_polygons(const Mask& mask) {
  std::vector<Polygon> exact = part_polygons(mask, kOnPixelEdges);
  std::vector<Outline> outlines;
  std::size_t vertices = 0;
  outlines.reserve(exact.size());
  for (const Polygon& polygon : exact) {
    outlines.push_back(outline_of(polygon));
    vertices += polygon.size();
  }
  constexpr double kLargestTolerance = 4.0;
  constexpr double kSmallestTolerance = 0.5;
  for (double pixels = kLargestTolerance; pixels >= kSmallestTolerance; pixels /= 2) {
    std::vector<Polygon> fewer;
    fewer.reserve(exact.size());
    bool possible = true;
    std::size_t left = 0;
    for (const Outline& outline : outlines) {
      fewer.push_back(simplified(outline, pixels * kVerticesPerPixel));
      possible = possible && fewer.back().size() >= 3;
      left += fewer.back().size();
    }
    if (possible && left < vertices &&
        polygon_iou(fewer, mask, FillRule::kCoco) >= kLeastSimplifiedIou)
      return fewer;
  }
  return exact;
}

}  // namespace seedframe
