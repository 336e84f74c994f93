#include "mesh/hole_filling.h"

#include <iterator>
#include <vector>

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include "mesh/cgal_surface.h"

namespace seedframe {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Face = CgalSurface::Face_index;
using Halfedge = CgalSurface::Halfedge_index;

std::size_t rim_length(const CgalSurface& surface, Halfedge border) {
  std::size_t length = 0;
  for ([[maybe_unused]] const Halfedge edge : CGAL::halfedges_around_face(border, surface))
    ++length;
  return length;
}

// A triangle that the surface had around the rim, for each vertex of the rim.
void add_triangle(Mesh& mesh, const CgalSurface& surface, Face face, std::size_t old_triangle,
                  const std::vector<std::uint32_t>& corner_at) {
  std::array<std::uint32_t, 3> triangle{};
  std::size_t i = 0;
  for (const auto vertex : CGAL::vertices_around_face(surface.halfedge(face), surface)) {
    triangle[i++] = static_cast<std::uint32_t>(vertex.idx());
  }
  mesh.triangles.push_back(triangle);
  mesh.triangle_slots.push_back(mesh.triangle_slots[old_triangle]);
  for (const std::uint32_t vertex : triangle) {
    const std::array<float, 2> uv = mesh.corner_uvs[corner_at[vertex]];
    mesh.corner_uvs.push_back(uv);
  }
}

}  // namespace

FilledHoles fill_holes(Mesh& mesh, std::size_t most_edges) {
  FilledHoles filled;
  auto surface = cgal_surface(mesh);
  if (!surface) return filled;
  std::vector<std::uint32_t> corner_at(mesh.positions.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      corner_at[mesh.triangles[t][corner]] = 3 * t + corner;
    }
  }
  std::vector<Halfedge> borders;
  pmp::extract_boundary_cycles(*surface, std::back_inserter(borders));
  for (const Halfedge border : borders) {
    if (rim_length(*surface, border) > most_edges) continue;
    const std::size_t rim = surface->face(surface->opposite(border)).idx();
    std::vector<Face> patch;
    pmp::triangulate_hole(*surface, border, std::back_inserter(patch));
    if (patch.empty()) continue;
    ++filled.holes;
    filled.triangles += patch.size();
    for (const Face face : patch) add_triangle(mesh, *surface, face, rim, corner_at);
  }
  return filled;
}

}  // namespace seedframe
