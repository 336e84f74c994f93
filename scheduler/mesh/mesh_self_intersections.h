// Where the surface of a mesh runs through itself.
#pragma once

#include <cstddef>
#include <string>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

/// More pairs are not counted.
inline constexpr std::size_t kMostSelfIntersections = 1'000'000;

/// Pairs of triangles that meet elsewhere than in a common edge or vertex, up to
/// kMostSelfIntersections; the mesh must be an oriented manifold.
Result<std::size_t> count_self_intersections(const Mesh& mesh, const std::string& what);

}  // namespace seedframe
