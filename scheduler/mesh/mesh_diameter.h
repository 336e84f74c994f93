// The largest distance between two vertices of a mesh.
#pragma once

#include "mesh/mesh.h"

namespace seedframe {

/// Metres; exact. 0 for a mesh of one vertex. Pairs of boxes of vertices that cannot be as far
/// apart as what was found are not looked into, so a million vertices take a second or so.
double mesh_diameter(const Mesh& mesh);

}  // namespace seedframe
