#include "mesh/mesh_repair.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>

#include "mesh/cgal_guard.h"
#include "mesh/hole_filling.h"
#include "mesh/mesh_edges.h"
#include "mesh/triangle_tree.h"

namespace seedframe {
namespace {

using Point = CgalKernel::Point_3;

Point point_of(const Mesh& mesh, std::uint32_t vertex) {
  const auto& p = mesh.positions[vertex];
  return {p[0], p[1], p[2]};
}

// Keeps the triangles that are marked, in their order.
void keep_triangles(Mesh& mesh, const std::vector<bool>& kept) {
  std::size_t out = 0;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (!kept[t]) continue;
    mesh.triangles[out] = mesh.triangles[t];
    mesh.triangle_slots[out] = mesh.triangle_slots[t];
    std::copy_n(mesh.corner_uvs.begin() + static_cast<std::ptrdiff_t>(3 * t), 3,
                mesh.corner_uvs.begin() + static_cast<std::ptrdiff_t>(3 * out));
    ++out;
  }
  mesh.triangles.resize(out);
  mesh.triangle_slots.resize(out);
  mesh.corner_uvs.resize(3 * out);
}

// A stray vertex would enlarge the box that objects are measured and placed by.
std::size_t drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> new_index(mesh.positions.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) new_index[vertex] = 1;
  }
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] == 0) continue;
    mesh.positions[used] = mesh.positions[i];
    new_index[i] = used++;
  }
  const std::size_t dropped = mesh.positions.size() - used;
  if (dropped == 0) return 0;
  mesh.positions.resize(used);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = new_index[vertex];
  }
  return dropped;
}

// A slot may come without triangles, or lose them to the repairs: nobody could give it a material.
std::size_t drop_unused_slots(Mesh& mesh) {
  std::vector<std::uint32_t> new_index(mesh.slot_names.size(), 0);
  for (const std::uint32_t slot : mesh.triangle_slots) new_index[slot] = 1;
  std::uint32_t used = 0;
  for (std::size_t slot = 0; slot < new_index.size(); ++slot) {
    if (new_index[slot] == 0) continue;
    if (used != slot) mesh.slot_names[used] = std::move(mesh.slot_names[slot]);
    new_index[slot] = used++;
  }
  const std::size_t dropped = mesh.slot_names.size() - used;
  mesh.slot_names.resize(used);
  for (std::uint32_t& slot : mesh.triangle_slots) slot = new_index[slot];
  return dropped;
}

bool names_a_vertex_twice(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Corners at the same place count as in line.
bool has_no_area(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return CGAL::collinear(point_of(mesh, a), point_of(mesh, b), point_of(mesh, c));
}

// A triangle of three vertices in a line cannot be seen, but without it the surface around it would
// come apart; only those at a border, which nothing hangs on, are removed with those that name a
// vertex twice.
void remove_degenerate(Mesh& mesh, RepairReport& report) {
  std::vector<bool> flat(mesh.triangles.size(), false);
  std::vector<bool> kept(mesh.triangles.size(), true);
  for (std::size_t t = 0; t < kept.size(); ++t) {
    kept[t] = !names_a_vertex_twice(mesh.triangles[t]);
    flat[t] = kept[t] && has_no_area(mesh, t);
  }
  for_each_edge(edge_uses(mesh), [&](std::span<const EdgeUse> sides) {
    if (sides.size() == 1 && flat[sides[0].triangle]) kept[sides[0].triangle] = false;
  });
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (!kept[t]) ++report.degenerate_triangles;
    if (kept[t] && flat[t]) ++report.kept_slivers;
  }
  if (report.degenerate_triangles > 0) keep_triangles(mesh, kept);
}

// Whichever way round: two triangles over each other flicker in a render.
void remove_duplicates(Mesh& mesh, RepairReport& report) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> keys;
  keys.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    auto key = mesh.triangles[t];
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> kept(mesh.triangles.size(), true);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first != keys[i - 1].first) continue;
    kept[keys[i].second] = false;
    ++report.duplicate_triangles;
  }
  if (report.duplicate_triangles > 0) keep_triangles(mesh, kept);
}

// Borders at the same place that run in opposite directions become one edge, if there are just two
// of them: files that store vertices once for each seam of UVs or normals come apart otherwise.
void join_borders(Mesh& mesh, RepairReport& report) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, std::vector<EdgeUse>> borders;
  for_each_edge(edge_uses(mesh), [&](std::span<const EdgeUse> sides) {
    if (sides.size() != 1) return;
    const Place& low = mesh.positions[sides[0].low];
    const Place& high = mesh.positions[sides[0].high];
    if (low != high) borders[std::minmax(low, high)].push_back(sides[0]);
  });
  DisjointSets vertices(mesh.positions.size());
  for (const auto& [places, sides] : borders) {
    if (sides.size() != 2) continue;
    const auto start = [&](const EdgeUse& side) {
      return mesh.triangles[side.triangle][side.corner];
    };
    const auto end = [&](const EdgeUse& side) {
      return mesh.triangles[side.triangle][(side.corner + 1) % 3];
    };
    if (mesh.positions[start(sides[0])] != mesh.positions[end(sides[1])]) continue;
    vertices.join(start(sides[0]), end(sides[1]));
    vertices.join(end(sides[0]), start(sides[1]));
    ++report.joined_edges;
  }
  if (report.joined_edges == 0) return;
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = vertices.find(vertex);
  }
  drop_unused_vertices(mesh);  // not counted: the repair made them
}

// Says which triangles CGAL turned round.
struct TurnVisitor : CGAL::Polygon_mesh_processing::Default_orientation_visitor {
  explicit TurnVisitor(std::vector<bool>* turned_triangles) : turned(turned_triangles) {}
  void polygon_orientation_reversed(std::size_t triangle) {
    (*turned)[triangle] = !(*turned)[triangle];
  }
  std::vector<bool>* turned;
};

void count_topology_faults(const Mesh& mesh, RepairReport& report, bool& oriented) {
  const auto uses = edge_uses(mesh);
  oriented = true;
  for_each_edge(uses, [&](std::span<const EdgeUse> sides) {
    if (sides.size() > 2) ++report.non_manifold_edges;
    if (sides.size() == 2 && !is_manifold_edge(sides)) oriented = false;
  });
  report.non_manifold_vertices = non_manifold_vertices(mesh, uses);
}

// One direction for all triangles of a part, and vertices and edges taken apart where more than a
// surface meets in them (CGAL's orient_polygon_soup, which keeps the order of triangles).
void orient(Mesh& mesh, RepairReport& report) {
  bool oriented = true;
  count_topology_faults(mesh, report, oriented);
  if (oriented && report.non_manifold_edges == 0 && report.non_manifold_vertices == 0) return;
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  points.reserve(mesh.positions.size());
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) points.push_back(point_of(mesh, v));
  polygons.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) polygons.push_back({t[0], t[1], t[2]});
  std::vector<bool> turned(polygons.size(), false);
  CGAL::Polygon_mesh_processing::orient_polygon_soup(
      points, polygons, CGAL::parameters::visitor(TurnVisitor(&turned)));
  for (std::size_t v = mesh.positions.size(); v < points.size(); ++v) {
    const Point& p = points[v];
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  for (std::size_t t = 0; t < polygons.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      mesh.triangles[t][corner] = static_cast<std::uint32_t>(polygons[t][corner]);
    }
    if (!turned[t]) continue;
    ++report.turned_triangles;
    std::swap(mesh.corner_uvs[3 * t], mesh.corner_uvs[3 * t + 2]);
  }
}

// The closed parts of a mesh, and what their volumes say of their direction.
struct Solids {
  MeshParts parts;
  std::vector<bool> closed;
  std::vector<double> volume;
};

Solids find_solids(const Mesh& mesh) {
  const auto uses = edge_uses(mesh);
  Solids solids{.parts = mesh_parts(mesh, uses), .closed = {}, .volume = {}};
  solids.closed.assign(solids.parts.count, true);
  solids.volume.assign(solids.parts.count, 0.0);
  for_each_edge(uses, [&](std::span<const EdgeUse> sides) {
    if (!is_manifold_edge(sides)) solids.closed[solids.parts.part_of[sides[0].triangle]] = false;
  });
  const Eigen::Vector3d centre = bounding_box(mesh).centre();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& at = mesh.positions[mesh.triangles[t][i]];
      p[i] = Eigen::Vector3d(at[0], at[1], at[2]) - centre;
    }
    solids.volume[solids.parts.part_of[t]] += p[0].dot(p[1].cross(p[2])) / 6.0;
  }
  return solids;
}

// Whether a part lies inside the other closed parts of the mesh: then its inward direction makes it
// the wall of a cavity.
bool is_inside_others(const Mesh& mesh, const Solids& solids, std::uint32_t part) {
  CgalTriangles others;
  std::optional<Point> seen;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const std::uint32_t own = solids.parts.part_of[t];
    if (own == part) {
      if (!seen) seen = CGAL::centroid(point_of(mesh, a), point_of(mesh, b), point_of(mesh, c));
    } else if (solids.closed[own] && !has_no_area(mesh, t)) {
      others.emplace_back(point_of(mesh, a), point_of(mesh, b), point_of(mesh, c));
    }
  }
  if (others.empty() || !seen) return false;
  const TriangleTree tree(others.cbegin(), others.cend());
  // The direction is no axis, so that the ray seldom runs along edges.
  const CgalKernel::Ray_3 ray(*seen, CgalKernel::Vector_3(0.5377, 0.2113, 0.8163));
  return tree.number_of_intersected_primitives(ray) % 2 == 1;
}

void face_outward(Mesh& mesh, RepairReport& report) {
  const Solids solids = find_solids(mesh);
  std::vector<bool> turn(solids.parts.count, false);
  constexpr std::size_t kMostTurns = 1000;  // each asks all triangles of the mesh
  for (std::uint32_t part = 0; part < solids.parts.count; ++part) {
    if (!solids.closed[part] || solids.volume[part] >= 0.0) continue;
    if (report.inside_out_parts == kMostTurns) break;
    if (is_inside_others(mesh, solids, part)) continue;
    turn[part] = true;
    ++report.inside_out_parts;
  }
  if (report.inside_out_parts == 0) return;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!turn[solids.parts.part_of[t]]) continue;
    std::swap(mesh.triangles[t][0], mesh.triangles[t][2]);
    std::swap(mesh.corner_uvs[3 * t], mesh.corner_uvs[3 * t + 2]);
  }
}

}  // namespace

bool RepairReport::changed() const {
  return unused_vertices + degenerate_triangles + duplicate_triangles + joined_edges +
             non_manifold_edges + non_manifold_vertices + turned_triangles + inside_out_parts +
             unused_slots + filled_holes >
         0;
}

Result<RepairedMesh> repair_mesh(const Mesh& mesh, const RepairOptions& options,
                                 const std::string& what) {
  return guard_cgal(what + ": repairing the mesh", [&]() -> Result<RepairedMesh> {
    RepairedMesh out{.mesh = mesh, .report = {}};
    remove_degenerate(out.mesh, out.report);
    remove_duplicates(out.mesh, out.report);
    out.report.unused_vertices = drop_unused_vertices(out.mesh);
    if (out.mesh.triangles.empty()) {
      return fail(ErrorKind::kInput, "{}: every triangle has zero area, so nothing could be seen",
                  what);
    }
    join_borders(out.mesh, out.report);
    orient(out.mesh, out.report);
    if (options.fill_holes > 0) {
      const FilledHoles filled = fill_holes(out.mesh, options.fill_holes);
      out.report.filled_holes = filled.holes;
      out.report.added_triangles = filled.triangles;
    }
    face_outward(out.mesh, out.report);
    out.report.unused_slots = drop_unused_slots(out.mesh);
    if (Status status = check_mesh(out.mesh, what); !status) return forward_error(status);
    return out;
  });
}

}  // namespace seedframe
