// Meshes that need no file.
#pragma once

#include "mesh/mesh.h"

namespace seedframe {

/// z = curvature · (x² + y²) / 2 over a rectangle about the origin, facing +z. One UV unit is one
/// metre, and UV (0, 0) is the origin. Its one slot is "ground". Two triangles when it is flat,
/// else 64 × 64 cells, shaded smooth.
Mesh ground_surface(double width_m, double depth_m, double curvature_per_m);

}  // namespace seedframe
