// The edges of a closed mesh, for finding its outline.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace seedframe {

/// Between two triangles: one has it from `from` to `to`, the other the other way round.
struct MeshEdge {
  std::uint32_t from = 0, to = 0;  ///< vertices
  std::uint32_t triangle = 0, opposite = 0;
};

/// All edges of a mesh in which every side of a triangle has another triangle on its other side,
/// turned the same way round; an edge of more triangles appears more than once. Vertices at one
/// place are one. Empty when the mesh is not closed so.
std::vector<MeshEdge> edges_of_closed_mesh(std::span<const std::array<float, 3>> positions,
                                           std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace seedframe
