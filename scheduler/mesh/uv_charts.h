// Where a mesh's UVs come apart, and UVs for points near it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/mesh.h"
#include "mesh/mesh_edges.h"

namespace seedframe {

/// Whether something ends at an edge: the surface, a material slot or the continuity of UVs.
bool is_feature_edge(const Mesh& mesh, std::span<const EdgeUse> sides);

/// For each triangle the number of its chart, from 0: triangles joined by edges that are not
/// feature edges.
MeshParts uv_charts(const Mesh& mesh, const std::vector<EdgeUse>& uses);

/// UVs of points on or near a mesh, chart by chart.
class UvSource {
 public:
  UvSource(const Mesh& mesh, const MeshParts& charts);
  ~UvSource();
  UvSource(const UvSource&) = delete;
  UvSource& operator=(const UvSource&) = delete;

  /// The UV of the point of a chart that is nearest to `point`. Where a chart meets itself at a
  /// seam, the side of it counts that is nearer to `inward`, a point close by.
  std::array<float, 2> uv_at(std::uint32_t chart, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& inward) const;

 private:
  struct Charts;
  const Mesh& mesh_;
  std::unique_ptr<Charts> charts_;
};

}  // namespace seedframe
