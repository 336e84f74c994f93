#include "mesh/uv_charts.h"

#include <algorithm>
#include <deque>

#include "mesh/triangle_distance.h"
#include "mesh/triangle_tree.h"

namespace seedframe {
namespace {

Eigen::Vector3d position_of(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

// The UV at the end of a side where the edge's vertex with the lower, or higher, number is.
const std::array<float, 2>& uv_at_end(const Mesh& mesh, const EdgeUse& side, bool low) {
  const std::size_t corner = side.rising == low ? side.corner : (side.corner + 1u) % 3u;
  return mesh.corner_uvs[3 * std::size_t{side.triangle} + corner];
}

}  // namespace

bool is_feature_edge(const Mesh& mesh, std::span<const EdgeUse> sides) {
  if (!is_manifold_edge(sides)) return true;
  if (mesh.triangle_slots[sides[0].triangle] != mesh.triangle_slots[sides[1].triangle]) return true;
  return uv_at_end(mesh, sides[0], true) != uv_at_end(mesh, sides[1], true) ||
         uv_at_end(mesh, sides[0], false) != uv_at_end(mesh, sides[1], false);
}

MeshParts uv_charts(const Mesh& mesh, const std::vector<EdgeUse>& uses) {
  std::vector<EdgeUse> joining;
  joining.reserve(uses.size());
  for_each_edge(uses, [&](std::span<const EdgeUse> sides) {
    if (!is_feature_edge(mesh, sides)) joining.insert(joining.end(), sides.begin(), sides.end());
  });
  return mesh_parts(mesh, joining);
}

struct UvSource::Charts {
  struct Chart {
    std::vector<std::uint32_t> numbers;  // of the triangles in the mesh
    CgalTriangles triangles;
    TriangleTree tree;
  };
  std::deque<Chart> charts;  // trees do not move
};

UvSource::UvSource(const Mesh& mesh, const MeshParts& charts)
    : mesh_(mesh), charts_(std::make_unique<Charts>()) {
  for (std::uint32_t chart = 0; chart < charts.count; ++chart) charts_->charts.emplace_back();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<CgalKernel::Point_3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& at = mesh.positions[mesh.triangles[t][i]];
      p[i] = {at[0], at[1], at[2]};
    }
    auto& chart = charts_->charts[charts.part_of[t]];
    const bool flat = CGAL::collinear(p[0], p[1], p[2]);
    if (flat && !chart.numbers.empty()) continue;
    // A chart of nothing but flat triangles keeps its first, for its UVs.
    if (!flat) chart.triangles.emplace_back(p[0], p[1], p[2]);
    if (chart.triangles.size() == 1) chart.numbers.clear();
    chart.numbers.push_back(t);
  }
  for (auto& chart : charts_->charts) {
    chart.tree.insert(chart.triangles.cbegin(), chart.triangles.cend());
    chart.tree.build();
  }
}

UvSource::~UvSource() = default;

std::array<float, 2> UvSource::uv_at(std::uint32_t number, const Eigen::Vector3d& point,
                                     const Eigen::Vector3d& inward) const {
  const auto& chart = charts_->charts[number];
  std::uint32_t triangle = chart.numbers.front();
  if (!chart.triangles.empty()) {
    const auto nearest =
        chart.tree.closest_point_and_primitive({inward.x(), inward.y(), inward.z()});
    triangle = chart.numbers[static_cast<std::size_t>(nearest.second - chart.triangles.cbegin())];
  }
  const auto& [a, b, c] = mesh_.triangles[triangle];
  const Eigen::Vector3d weights =
      nearest_weights(point, position_of(mesh_.positions[a]), position_of(mesh_.positions[b]),
                      position_of(mesh_.positions[c]));
  std::array<float, 2> uv{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += weights[static_cast<Eigen::Index>(i)] *
             mesh_.corner_uvs[3 * std::size_t{triangle} + i][axis];
    }
    uv[axis] = static_cast<float>(sum);
  }
  return uv;
}

}  // namespace seedframe
