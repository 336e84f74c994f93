// Triangles in CGAL's tree of boxes. Heavy, as cgal_surface.h is.
#pragma once

#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>

#include "mesh/cgal_surface.h"

namespace seedframe {

using CgalTriangles = std::vector<CgalKernel::Triangle_3>;
/// Refers to the triangles that it was made of: they must stay where they are.
using TriangleTree = CGAL::AABB_tree<CGAL::AABB_traits<
    CgalKernel, CGAL::AABB_triangle_primitive<CgalKernel, CgalTriangles::const_iterator>>>;

}  // namespace seedframe
