// Which triangles share which edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace seedframe {

/// One side of a triangle, from corner `corner` to the next.
struct EdgeUse {
  std::uint32_t low = 0;  ///< the edge's vertices, the smaller number first
  std::uint32_t high = 0;
  std::uint32_t triangle = 0;
  std::uint8_t corner = 0;
  bool rising = false;  ///< from low to high

  bool same_edge(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

/// All sides of all triangles, those of one edge side by side, by number of the triangle. Sides of
/// triangles that name a vertex twice are left out.
std::vector<EdgeUse> edge_uses(const Mesh& mesh);

/// Calls `function` with the sides of each edge in turn.
template <class Function>
void for_each_edge(const std::vector<EdgeUse>& uses, Function&& function) {
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t end = first + 1;
    while (end < uses.size() && uses[end].same_edge(uses[first])) ++end;
    function(std::span<const EdgeUse>(uses.data() + first, end - first));
    first = end;
  }
}

/// Two triangles that run along it in opposite directions.
inline bool is_manifold_edge(std::span<const EdgeUse> sides) {
  return sides.size() == 2 && sides[0].rising != sides[1].rising;
}

/// Sets of things by number, joined step by step (union and find).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count);
  /// The number that stands for all of its set: the least one.
  std::uint32_t find(std::uint32_t item);
  void join(std::uint32_t a, std::uint32_t b);

 private:
  std::vector<std::uint32_t> parent_;
};

/// For each triangle the number of its part, from 0, in order of first triangles. Triangles that
/// share an edge are of one part; those that share a vertex only need not be.
struct MeshParts {
  std::vector<std::uint32_t> part_of;
  std::uint32_t count = 0;
};
MeshParts mesh_parts(const Mesh& mesh, const std::vector<EdgeUse>& uses);

/// Vertices around which the triangles make up more than one fan.
std::size_t non_manifold_vertices(const Mesh& mesh, const std::vector<EdgeUse>& uses);

}  // namespace seedframe
