#include <iterator>

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include "mesh/cgal_guard.h"
#include "mesh/cgal_surface.h"
#include "mesh/mesh_measure.h"

namespace seedframe {
namespace {

// Counts what is written to it, without keeping it.
struct Counter {
  using iterator_category = std::output_iterator_tag;
  using value_type = void;
  using difference_type = std::ptrdiff_t;
  using pointer = void;
  using reference = void;

  std::size_t* count;
  Counter& operator*() { return *this; }
  Counter& operator++() { return *this; }
  Counter operator++(int) { return *this; }
  template <class T>
  Counter& operator=(const T&) {
    ++*count;
    return *this;
  }
};

}  // namespace

Result<std::size_t> count_self_intersections(const Mesh& mesh, const std::string& what) {
  return guard_cgal(what + ": looking for self-intersections", [&]() -> Result<std::size_t> {
    const auto surface = cgal_surface(mesh);
    if (!surface) return fail(ErrorKind::kInput, "{}: the mesh is not an oriented manifold", what);
    std::size_t count = 0;
    CGAL::Polygon_mesh_processing::self_intersections(
        *surface, Counter{&count},
        CGAL::parameters::maximum_number(static_cast<unsigned>(kMostSelfIntersections)));
    return count;
  });
}

}  // namespace seedframe
