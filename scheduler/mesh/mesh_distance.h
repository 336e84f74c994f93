// How far two surfaces are apart.
#pragma once

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

/// The two-sided Hausdorff distance of two surfaces lies in [lower_m, upper_m]: every point of one
/// is within upper_m of the other, both ways, and some point is lower_m away.
struct SurfaceDistance {
  double lower_m = 0.0;
  double upper_m = 0.0;
};

/// The interval is at most tolerance_m wide, or wider where that would take millions of steps; it
/// holds in any case. Branch and bound as in CGAL's bounded-error distance (Tang, Lee and Kim,
/// "Interactive Hausdorff distance computation for general polygonal models", 2009); faster where
/// the surfaces lie close to each other, because a triangle is first cut into what lies over single
/// triangles of the other one. Triangles without area count for nothing.
Result<SurfaceDistance> hausdorff_distance(const Mesh& a, const Mesh& b, double tolerance_m,
                                           const std::string& what);

/// A lower bound only, but quickly: the greatest distance of the vertices, middles of edges and
/// centres of triangles of each from the other; upper_m is infinite.
Result<SurfaceDistance> sampled_distance(const Mesh& a, const Mesh& b, const std::string& what);

}  // namespace seedframe
