#include "mesh/mesh_edges.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace seedframe {

std::vector<EdgeUse> edge_uses(const Mesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    for (std::uint8_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = triangle[corner];
      const std::uint32_t b = triangle[(corner + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, corner, a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) <
           std::tie(b.low, b.high, b.triangle, b.corner);
  });
  return uses;
}

DisjointSets::DisjointSets(std::size_t count) : parent_(count) {
  std::iota(parent_.begin(), parent_.end(), 0u);
}

std::uint32_t DisjointSets::find(std::uint32_t item) {
  while (parent_[item] != item) {
    parent_[item] = parent_[parent_[item]];
    item = parent_[item];
  }
  return item;
}

void DisjointSets::join(std::uint32_t a, std::uint32_t b) {
  a = find(a);
  b = find(b);
  parent_[std::max(a, b)] = std::min(a, b);
}

MeshParts mesh_parts(const Mesh& mesh, const std::vector<EdgeUse>& uses) {
  DisjointSets sets(mesh.triangles.size());
  for_each_edge(uses, [&](std::span<const EdgeUse> sides) {
    for (const EdgeUse& side : sides) sets.join(sides[0].triangle, side.triangle);
  });
  MeshParts parts{.part_of = std::vector<std::uint32_t>(mesh.triangles.size()), .count = 0};
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t first = sets.find(t);
    parts.part_of[t] = first == t ? parts.count++ : parts.part_of[first];
  }
  return parts;
}

std::size_t non_manifold_vertices(const Mesh& mesh, const std::vector<EdgeUse>& uses) {
  // Corners of one vertex are joined where their triangles share an edge that ends there.
  DisjointSets corners(3 * mesh.triangles.size());
  const auto corner_at = [&](const EdgeUse& side, bool at_low) {
    return 3 * side.triangle + (side.rising == at_low ? side.corner : (side.corner + 1) % 3);
  };
  for_each_edge(uses, [&](std::span<const EdgeUse> sides) {
    if (sides.size() != 2) return;
    for (const bool at_low : {true, false}) {
      corners.join(corner_at(sides[0], at_low), corner_at(sides[1], at_low));
    }
  });
  std::vector<std::uint8_t> fans(mesh.positions.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (a == b || b == c || c == a) continue;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      std::uint8_t& count = fans[mesh.triangles[t][corner]];
      if (corners.find(3 * t + corner) == 3 * t + corner && count < 2) ++count;
    }
  }
  return static_cast<std::size_t>(std::count(fans.begin(), fans.end(), std::uint8_t{2}));
}

}  // namespace seedframe
