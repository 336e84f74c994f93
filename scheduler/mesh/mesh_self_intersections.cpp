#include "mesh/mesh_self_intersections.h"

#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <boost/iterator/function_output_iterator.hpp>

#include "mesh/cgal_guard.h"
#include "mesh/cgal_surface.h"

namespace seedframe {

Result<std::size_t> count_self_intersections(const Mesh& mesh, const std::string& what) {
  return guard_cgal(what + ": looking for self-intersections", [&]() -> Result<std::size_t> {
    const auto surface = cgal_surface(mesh);
    if (!surface) return fail(ErrorKind::kInput, "{}: the mesh is not an oriented manifold", what);
    std::size_t count = 0;
    CGAL::Polygon_mesh_processing::self_intersections(
        *surface, boost::make_function_output_iterator([&count](const auto&) { ++count; }),
        CGAL::parameters::maximum_number(static_cast<unsigned>(kMostSelfIntersections)));
    return count;
  });
}

}  // namespace seedframe
