// Which triangles are near a point.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace seedframe {

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// Triangles in a tree of boxes that are halved along their longest side. In double, without exact
/// predicates: for distances, several times as fast as CGAL's tree, which answers what must be
/// decided exactly (triangle_tree.h).
class TriangleSearch {
 public:
  explicit TriangleSearch(std::vector<TriangleCorners> triangles);

  bool empty() const { return triangles_.empty(); }
  const std::vector<TriangleCorners>& triangles() const { return triangles_; }

  struct Nearest {
    std::uint32_t triangle = 0;
    double squared_distance = 0.0;
  };
  /// There must be a triangle; of several that are as near, always the same one.
  Nearest nearest(const Eigen::Vector3d& point) const;

  /// Whether one is within the distance of the point.
  bool any_within(const Eigen::Vector3d& point, double squared_distance) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0;  ///< into order_, of a leaf; else the left child, the right is next
    std::uint32_t count = 0;  ///< triangles of a leaf; 0: not a leaf
  };
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  double squared_to(std::uint32_t triangle, const Eigen::Vector3d& point) const;

  std::vector<TriangleCorners> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace seedframe
