// Meshes that need no file.
#pragma once

#include "geometry/mesh.h"

namespace seedframe {

/// Two triangles in z = 0, centred on the origin, facing +z. One UV unit is one metre, and UV (0,
/// 0) is the origin. Its one slot is "ground".
Mesh ground_plane(double width_m, double depth_m);

}  // namespace seedframe
