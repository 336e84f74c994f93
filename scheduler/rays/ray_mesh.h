// A mesh ready for rays: Embree's tree over its triangles, shared by all of its instances and
// frames.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "rays/mesh_edges.h"

namespace seedframe {

/// In object space. Safe to use from several threads.
class RayMesh {
 public:
  /// The mesh must pass check_mesh. Throws std::bad_alloc when there is no memory for the tree.
  explicit RayMesh(const Mesh& mesh);
  ~RayMesh();
  RayMesh(const RayMesh&) = delete;
  RayMesh& operator=(const RayMesh&) = delete;

  const BoundingBox& box() const { return box_; }
  std::size_t triangle_count() const;

  /// Shading normals, three per triangle (corner_normals.h); made when first asked for.
  const std::vector<std::array<float, 3>>& normals() const;

  /// Those of a closed mesh (mesh_edges.h), else empty; made when first asked for.
  const std::vector<MeshEdge>& edges() const;

  struct Tree;
  const Tree& tree() const { return *tree_; }

 private:
  std::unique_ptr<Tree> tree_;
  BoundingBox box_;
  double smooth_angle_rad_ = 0.0;
  mutable std::once_flag normals_made_;
  mutable std::vector<std::array<float, 3>> normals_;
  mutable std::once_flag edges_made_;
  mutable std::vector<MeshEdge> edges_;
};

/// Bytes that Embree holds at present, for all trees of the process together.
std::size_t ray_tracing_bytes();

/// Embree's, such as "3.13.5".
std::string ray_tracing_version();

/// The instruction set that Embree uses here: "sse2", "sse4.2", "avx" or "avx2". Never a higher
/// one, so that all CPUs of the last ten years find the same pixels.
std::string ray_tracing_isa();

}  // namespace seedframe
