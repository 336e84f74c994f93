// Coarser versions of a mesh by edge collapse.
#pragma once

#include <memory>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

/// Collapses edges of one mesh, further and further (edge cost and placement: Lindstrom and Turk,
/// "Fast and memory efficient polygonal simplification", 1998; CGAL).
///
/// A collapse is made only if
/// - every vertex of the original that lay on the triangles around stays within the tolerance of
///   them, and the new triangles' corners, centres and middles of edges within the tolerance of the
///   original (after Klein, Liebich and Strasser, "Mesh reduction with error control", 1996): what
///   is between these points must be measured afterwards;
/// - open borders, borders of slots and UV seams stay lines with the same ends, within the
///   tolerance of the original's vertices on them;
/// - no triangle turns by more than about 75 degrees.
///
/// Deterministic.
class MeshSimplifier {
 public:
  /// The mesh must be an oriented manifold; it is copied.
  static Result<MeshSimplifier> create(const Mesh& mesh, const std::string& what);
  MeshSimplifier(const MeshSimplifier& other);
  MeshSimplifier(MeshSimplifier&& other) noexcept;
  MeshSimplifier& operator=(MeshSimplifier&& other) noexcept;
  MeshSimplifier& operator=(const MeshSimplifier&) = delete;
  ~MeshSimplifier();

  /// Goes on until no edge is left that may be collapsed. Distances are to the original, however
  /// often this is called.
  Status simplify(double tolerance_m);

  std::size_t triangle_count() const;

  /// UVs of corners are those of the nearest point of the original, in the same chart.
  Mesh mesh() const;

 private:
  struct State;
  explicit MeshSimplifier(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace seedframe
