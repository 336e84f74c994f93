// How large a texture comes out on a mesh, and texture coordinates for meshes that have none.
#pragma once

#include "mesh/mesh.h"

namespace seedframe {

/// Whether the mesh has texture coordinates: any two of its corners differ in them.
bool has_uvs(const Mesh& mesh);

/// Gives each triangle texture coordinates in metres, by looking at it along that of the three axes
/// of the asset that is nearest to its normal: seen from outside, u points right and v up (z, or y
/// where the triangle faces up or down), and pictures are not mirrored.
void project_uvs(Mesh& mesh);

/// Metres of surface that a unit of UV covers: the root of the ratio of the areas, over all
/// triangles. 1 for a mesh whose coordinates enclose no area.
double metres_per_uv(const Mesh& mesh);

}  // namespace seedframe
