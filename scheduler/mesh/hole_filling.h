// Closes holes of a mesh.
#pragma once

#include <cstddef>

#include "mesh/mesh.h"

namespace seedframe {

struct FilledHoles {
  std::size_t holes = 0;
  std::size_t triangles = 0;
};

/// Closes the holes of an oriented manifold that have at most `most_edges` edges, by the
/// triangulation that folds least (Liepa, "Filling holes in meshes", 2003; CGAL). New triangles
/// come last; each takes its slot and its UVs from the rim. Holes that no triangulation fits stay
/// open. May throw what CGAL throws.
FilledHoles fill_holes(Mesh& mesh, std::size_t most_edges);

}  // namespace seedframe
