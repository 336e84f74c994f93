// The triangles around an edge before and after it is collapsed: whether the collapse keeps the
// tolerance, and what they must remember of the original. Heavy, for mesh_simplify.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/cgal_surface.h"
#include "mesh/triangle_search.h"
#include "mesh/uv_charts.h"

namespace seedframe {

/// What does not change while a mesh is simplified.
struct SimplifyOriginal {
  Mesh mesh;
  MeshParts charts;
  /// Points of the surface that must stay near: its vertices by their numbers, then the middles of
  /// its edges and of its triangles.
  std::vector<Eigen::Vector3d> samples;
  std::unique_ptr<TriangleSearch> surface;  ///< the triangles with an area
  std::unique_ptr<UvSource> uvs;
};

/// A surface whose parts know what of the original they stand for.
struct TracedSurface {
  using Vertex = CgalSurface::Vertex_index;
  using Halfedge = CgalSurface::Halfedge_index;
  using Edge = CgalSurface::Edge_index;
  using Face = CgalSurface::Face_index;
  using Samples = std::vector<std::uint32_t>;  ///< numbers of SimplifyOriginal::samples

  explicit TracedSurface(CgalSurface from);
  TracedSurface(const TracedSurface& other) : TracedSurface(other.surface) {}
  TracedSurface& operator=(const TracedSurface&) = delete;

  bool is_feature(Halfedge halfedge) const { return feature[surface.edge(halfedge)]; }
  /// Feature edges that end at a vertex.
  std::size_t feature_degree(Vertex vertex) const;

  CgalSurface surface;
  CgalSurface::Property_map<Edge, bool> feature;   ///< a border, or an edge between charts
  CgalSurface::Property_map<Edge, Samples> along;  ///< of a feature edge: samples on it
  CgalSurface::Property_map<Face, Samples> on;     ///< samples that lie nearest to the face
  CgalSurface::Property_map<Face, std::uint32_t> chart;
  CgalSurface::Property_map<Edge, bool> locked;  ///< never collapsed
};

/// One collapse: of the edge of `halfedge`, to `point`.
class CollapseRing {
 public:
  CollapseRing(const TracedSurface& traced, TracedSurface::Halfedge halfedge,
               const CgalKernel::Point_3& point);

  /// Whether it keeps what MeshSimplifier promises. Finds out what goes where on the way.
  bool keeps(const SimplifyOriginal& original, double tolerance_m);

  /// After the collapse, which kept or made `vertex`: writes down what goes where.
  void apply(TracedSurface& traced, TracedSurface::Vertex vertex);

 private:
  struct Triangle {  // of the ring; its third corner moves
    TracedSurface::Face face;
    TracedSurface::Vertex a, b;
    Eigen::Vector3d at_a, at_b, before;
    std::uint32_t chart = 0;
    TracedSurface::Samples on;
  };
  struct Spoke {  // a feature edge from the ring to the moving vertex
    TracedSurface::Edge edge;
    TracedSurface::Vertex end;
    Eigen::Vector3d at;
    TracedSurface::Samples along;
  };

  void collect(TracedSurface::Halfedge halfedge);
  void collect_spokes(TracedSurface::Halfedge halfedge);
  void collect_samples();
  bool keeps_direction() const;
  bool keeps_original_near(const SimplifyOriginal& original, double squared_tolerance);
  bool keeps_lines_near(const SimplifyOriginal& original, double squared_tolerance);
  bool stays_near_original(const SimplifyOriginal& original, double squared_tolerance) const;

  const TracedSurface& traced_;
  TracedSurface::Halfedge halfedge_;
  Eigen::Vector3d point_;
  std::vector<Triangle> triangles_;
  std::vector<Spoke> spokes_;
  TracedSurface::Samples loose_on_;     // of the two triangles that vanish
  TracedSurface::Samples loose_along_;  // of the edge, if it is a feature edge
};

}  // namespace seedframe
