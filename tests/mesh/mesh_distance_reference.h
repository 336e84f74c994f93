// CGAL's own distance of two surfaces, which ours is held against.
#pragma once

#include <string>

#include "mesh/mesh_distance.h"

namespace seedframe {

/// hausdorff_distance by CGAL; the interval is 2 · tolerance_m wide.
Result<SurfaceDistance> reference_hausdorff_distance(const Mesh& a, const Mesh& b,
                                                     double tolerance_m, const std::string& what);

}  // namespace seedframe
