// A mesh as CGAL's half-edge structure. Heavy: for the .cpp files that call CGAL only.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "mesh/mesh.h"

namespace seedframe {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalSurface = CGAL::Surface_mesh<CgalKernel::Point_3>;

inline CgalKernel::Point_3 cgal_point(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }
inline CgalKernel::Point_3 cgal_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
inline Eigen::Vector3d vector_of(const CgalKernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

/// Vertices and faces have the mesh's numbers. Nothing unless the mesh is an oriented manifold.
inline std::optional<CgalSurface> cgal_surface(const Mesh& mesh) {
  CgalSurface surface;
  surface.reserve(static_cast<CgalSurface::size_type>(mesh.positions.size()),
                  static_cast<CgalSurface::size_type>(3 * mesh.triangles.size() / 2),
                  static_cast<CgalSurface::size_type>(mesh.triangles.size()));
  for (const auto& position : mesh.positions) surface.add_vertex(cgal_point(position));
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto face = surface.add_face(CgalSurface::Vertex_index(a), CgalSurface::Vertex_index(b),
                                       CgalSurface::Vertex_index(c));
    if (face == CgalSurface::null_face()) return std::nullopt;
  }
  return surface;
}

}  // namespace seedframe
