// Polygons of input files into triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace seedframe {

/// Cuts a simple polygon, convex or not, into n − 2 triangles of corner numbers, wound as the
/// polygon is. Ear clipping (Meisters, "Polygons have ears", 1975) in the plane that fits the
/// corners best by Newell's normal, with CGAL's exact predicates. A polygon that crosses itself is
/// cut somehow, without losing its outline.
std::vector<std::array<std::size_t, 3>> triangulate(const std::vector<Eigen::Vector3d>& corners);

}  // namespace seedframe
