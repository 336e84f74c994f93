#include "mesh/triangle_search.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "mesh/triangle_distance.h"

namespace seedframe {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr std::uint32_t kLeafSize = 4;
// A tree that is halved at the median of 2^32 triangles is no deeper.
constexpr std::size_t kMostWaiting = 64;

// Nodes that are still to be looked at.
struct Waiting {
  std::uint32_t node;
  double squared_distance;
};

}  // namespace

TriangleSearch::TriangleSearch(std::vector<TriangleCorners> triangles)
    : triangles_(std::move(triangles)), order_(triangles_.size()) {
  if (triangles_.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(2 * triangles_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(triangles_.size()));
}

void TriangleSearch::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  const auto centre = [this](std::uint32_t triangle, Eigen::Index axis) {
    const TriangleCorners& t = triangles_[triangle];
    return t[0][axis] + t[1][axis] + t[2][axis];
  };
  Box box;
  Box centres;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const TriangleCorners& t = triangles_[order_[i]];
    for (const Eigen::Vector3d& corner : t) box.extend(corner);
    centres.extend(t[0] + t[1] + t[2]);
  }
  nodes_[node] = {box, first, count};
  if (count <= kLeafSize) return;
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const double ca = centre(a, axis);
    const double cb = centre(b, axis);
    return ca != cb ? ca < cb : a < b;
  });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_.emplace_back();
  nodes_[node].first = left;
  nodes_[node].count = 0;
  build(left, first, half);
  build(left + 1, first + half, count - half);
}

double TriangleSearch::squared_to(std::uint32_t triangle, const Eigen::Vector3d& point) const {
  const auto& [a, b, c] = triangles_[triangle];
  return squared_distance_to_triangle(point, a, b, c);
}

TriangleSearch::Nearest TriangleSearch::nearest(const Eigen::Vector3d& point) const {
  Nearest best{.triangle = 0, .squared_distance = std::numeric_limits<double>::infinity()};
  std::array<Waiting, kMostWaiting> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, nodes_[0].box.squaredExteriorDistance(point)};
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (next.squared_distance > best.squared_distance) continue;
    const Node& node = nodes_[next.node];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double squared = squared_to(order_[i], point);
      if (squared < best.squared_distance) best = {order_[i], squared};
    }
    if (node.count > 0) continue;
    Waiting left{node.first, nodes_[node.first].box.squaredExteriorDistance(point)};
    Waiting right{node.first + 1, nodes_[node.first + 1].box.squaredExteriorDistance(point)};
    if (left.squared_distance < right.squared_distance) std::swap(left, right);
    waiting[count++] = left;  // the farther one waits longer
    waiting[count++] = right;
  }
  return best;
}

bool TriangleSearch::any_within(const Eigen::Vector3d& point, double squared_distance) const {
  if (nodes_.empty()) return false;
  std::array<std::uint32_t, kMostWaiting> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const Node& node = nodes_[waiting[--count]];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (squared_to(order_[i], point) <= squared_distance) return true;
    }
    if (node.count > 0) continue;
    const double left = nodes_[node.first].box.squaredExteriorDistance(point);
    const double right = nodes_[node.first + 1].box.squaredExteriorDistance(point);
    const bool left_is_nearer = left < right;
    const std::uint32_t farther = left_is_nearer ? node.first + 1 : node.first;
    if (std::max(left, right) <= squared_distance) waiting[count++] = farther;
    if (std::min(left, right) <= squared_distance) {
      waiting[count++] = left_is_nearer ? node.first : node.first + 1;
    }
  }
  return false;
}

}  // namespace seedframe
