#include "tests/mesh/mesh_distance_reference.h"

#include <algorithm>

// distance.h calls functions of the kernel without including them: the kernel comes first.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>

#include "mesh/cgal_guard.h"
#include "mesh/cgal_surface.h"

namespace seedframe {
namespace {

// Every triangle by itself: distances need no neighbours, and meshes need be no manifolds.
CgalSurface loose_triangles(const Mesh& mesh) {
  CgalSurface surface;
  for (const auto& triangle : mesh.triangles) {
    std::array<CgalKernel::Point_3, 3> points;
    for (std::size_t i = 0; i < 3; ++i) points[i] = cgal_point(mesh.positions[triangle[i]]);
    if (CGAL::collinear(points[0], points[1], points[2])) continue;
    const auto a = surface.add_vertex(points[0]);
    const auto b = surface.add_vertex(points[1]);
    const auto c = surface.add_vertex(points[2]);
    surface.add_face(a, b, c);
  }
  return surface;
}

}  // namespace

Result<SurfaceDistance> reference_hausdorff_distance(const Mesh& a, const Mesh& b,
                                                     double tolerance_m, const std::string& what) {
  return guard_cgal(what + ": measuring a distance", [&]() -> Result<SurfaceDistance> {
    const CgalSurface first = loose_triangles(a);
    const CgalSurface second = loose_triangles(b);
    if (first.number_of_faces() == 0 || second.number_of_faces() == 0) {
      return fail(ErrorKind::kInput, "{}: there is no surface to measure a distance from", what);
    }
    const double distance =
        CGAL::Polygon_mesh_processing::bounded_error_symmetric_Hausdorff_distance<
            CGAL::Sequential_tag>(first, second, tolerance_m, CGAL::parameters::match_faces(false),
                                  CGAL::parameters::match_faces(false));
    return SurfaceDistance{.lower_m = std::max(0.0, distance - tolerance_m),
                           .upper_m = distance + tolerance_m};
  });
}

}  // namespace seedframe
