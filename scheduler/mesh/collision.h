// Whether two meshes touch, by CGAL.
#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "mesh/mesh.h"

namespace seedframe {

/// A mesh's tree of triangles, in object space; shared by all of its instances and frames.
class SolidMesh {
 public:
  explicit SolidMesh(const Mesh& mesh);
  ~SolidMesh();
  SolidMesh(const SolidMesh&) = delete;
  SolidMesh& operator=(const SolidMesh&) = delete;

  struct Tree;
  const Tree& tree() const { return *tree_; }

 private:
  std::unique_ptr<Tree> tree_;
};

struct SolidInstance {
  const SolidMesh* mesh = nullptr;
  BoundingBox box;  ///< of the mesh
  Eigen::Affine3d world_from_object = Eigen::Affine3d::Identity();
};

/// True if the surfaces meet, or one lies inside the other (which must be closed for that to be
/// seen), or, with gap_m above 0, if a vertex of one is nearer than gap_m to the surface of the
/// other. Two edges may come nearer to each other than any vertex does, by less than the length of
/// a triangle's edge.
bool nearer_than(const SolidInstance& a, const SolidInstance& b, double gap_m);

}  // namespace seedframe
