// Finds what is wrong with a mesh from a file and repairs what can be repaired.
#pragma once

#include <cstddef>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

struct RepairOptions {
  /// Holes with at most this many edges are closed; 0: none are.
  std::size_t fill_holes = 0;
};

/// How often each fault was found, and what became of it.
struct RepairReport {
  std::size_t unused_vertices = 0;       ///< removed
  std::size_t degenerate_triangles = 0;  ///< without area; removed
  std::size_t kept_slivers = 0;          ///< without area, but they hold the surface together: kept
  std::size_t duplicate_triangles = 0;   ///< with the vertices of an earlier one; removed
  std::size_t joined_edges = 0;          ///< pairs of borders at the same place; joined
  std::size_t non_manifold_edges = 0;    ///< with more than two triangles; taken apart
  std::size_t non_manifold_vertices = 0;  ///< where surfaces touch in a point; taken apart
  std::size_t turned_triangles = 0;       ///< wound against their neighbours; turned round
  std::size_t inside_out_parts = 0;       ///< closed parts that faced inward; turned round
  std::size_t unused_slots = 0;           ///< without triangles; removed
  std::size_t filled_holes = 0;
  std::size_t added_triangles = 0;  ///< by filling holes

  /// Whether the mesh was changed.
  bool changed() const;
};

struct RepairedMesh {
  Mesh mesh;
  RepairReport report;
};

/// The result is an oriented manifold, perhaps with borders, or an error (kInput) that names `what`
/// where nothing is left. UVs and slots follow their corners; a filled hole takes both from its
/// rim. A mesh without a fault comes back bit for bit. Of one with faults, triangles and vertices
/// keep their order.
Result<RepairedMesh> repair_mesh(const Mesh& mesh, const RepairOptions& options,
                                 const std::string& what);

}  // namespace seedframe
