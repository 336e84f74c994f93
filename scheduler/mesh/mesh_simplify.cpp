#include "mesh/mesh_simplify.h"

#include <cmath>

#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <boost/optional.hpp>

#include "mesh/cgal_guard.h"
#include "mesh/collapse_ring.h"

namespace seedframe {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Point = CgalKernel::Point_3;
using Halfedge = TracedSurface::Halfedge;
using Vertex = TracedSurface::Vertex;
using Vector = Eigen::Vector3d;

// Positions are stored as floats: what is checked is what will be stored.
boost::optional<Point> as_floats(const boost::optional<Point>& p) {
  if (!p) return p;
  const auto x = static_cast<float>(p->x());
  const auto y = static_cast<float>(p->y());
  const auto z = static_cast<float>(p->z());
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return boost::none;
  return Point(x, y, z);
}

// How many feature edges end at a vertex decides what it may do: none, it is free; two, it lies on
// a line and may move along; else it stays.
enum class Freedom { kFree, kOnLine, kFixed };

Freedom freedom_of(const TracedSurface& traced, Vertex vertex) {
  const std::size_t degree = traced.feature_degree(vertex);
  return degree == 0 ? Freedom::kFree : degree == 2 ? Freedom::kOnLine : Freedom::kFixed;
}

// Two lines that end in the edge must not fall into one.
bool merges_lines(const TracedSurface& traced, Halfedge halfedge) {
  const CgalSurface& surface = traced.surface;
  for (const Halfedge side : {halfedge, surface.opposite(halfedge)}) {
    if (surface.is_border(side)) continue;
    if (traced.is_feature(surface.next(side)) && traced.is_feature(surface.prev(side))) return true;
  }
  return false;
}

struct Placement {
  const TracedSurface* traced;

  template <class Profile>
  boost::optional<Point> operator()(const Profile& profile) const {
    const Freedom from = freedom_of(*traced, profile.v0());
    const Freedom to = freedom_of(*traced, profile.v1());
    if (from == Freedom::kFree && to == Freedom::kFree) {
      return as_floats(sms::LindstromTurk_placement<CgalSurface>()(profile));
    }
    if (from == Freedom::kFree) return profile.p1();
    if (to == Freedom::kFree) return profile.p0();
    if (!traced->is_feature(profile.v0_v1()) || merges_lines(*traced, profile.v0_v1())) {
      return boost::none;
    }
    if (from == Freedom::kFixed) {
      return to == Freedom::kFixed ? boost::none : boost::optional<Point>(profile.p0());
    }
    if (to == Freedom::kFixed) return profile.p1();
    return cheapest_of(profile);
  }

  template <class Profile>
  static boost::optional<Point> cheapest_of(const Profile& profile) {
    const sms::LindstromTurk_cost<CgalSurface> cost;
    boost::optional<Point> best;
    double least = 0.0;
    for (const auto& candidate :
         {boost::optional<Point>(profile.p0()), boost::optional<Point>(profile.p1()),
          as_floats(CGAL::midpoint(profile.p0(), profile.p1()))}) {
      const auto price = cost(profile, candidate);
      if (!price || (best && *price >= least)) continue;
      best = candidate;
      least = *price;
    }
    return best;
  }
};

// The collapse that the filter has let pass and CGAL is about to make.
struct Pending {
  std::unique_ptr<CollapseRing> ring;
};

struct Filter {
  const TracedSurface* traced;
  const SimplifyOriginal* original;
  double tolerance_m;
  Pending* pending;

  template <class Profile>
  boost::optional<Point> operator()(const Profile& profile, boost::optional<Point> point) const {
    if (!point) return point;
    auto ring = std::make_unique<CollapseRing>(*traced, profile.v0_v1(), *point);
    if (!ring->keeps(*original, tolerance_m)) return boost::none;
    pending->ring = std::move(ring);
    return point;
  }
};

struct Tracer : sms::Edge_collapse_visitor_base<CgalSurface> {
  Tracer(TracedSurface* surface, Pending* collapse) : traced(surface), pending(collapse) {}

  void OnCollapsed(const Profile& /*profile*/, Vertex vertex) {
    if (pending->ring) pending->ring->apply(*traced, vertex);
    pending->ring.reset();
  }

  TracedSurface* traced;
  Pending* pending;
};

// Only the filter says when it is enough.
struct NeverStop {
  template <class... Anything>
  bool operator()(const Anything&...) const {
    return false;
  }
};

// CGAL would collapse edges without length first, without asking anybody.
void lock_edges_without_length(TracedSurface& traced) {
  for (const auto edge : traced.surface.edges()) {
    traced.locked[edge] = traced.surface.point(traced.surface.vertex(edge, 0)) ==
                          traced.surface.point(traced.surface.vertex(edge, 1));
  }
}

// So they are collapsed here, as far as lines of features allow.
void collapse_edges_without_length(TracedSurface& traced, const SimplifyOriginal& original) {
  CgalSurface& surface = traced.surface;
  std::vector<TracedSurface::Edge> edges;
  for (const auto edge : surface.edges()) {
    if (surface.point(surface.vertex(edge, 0)) == surface.point(surface.vertex(edge, 1))) {
      edges.push_back(edge);
    }
  }
  for (const auto edge : edges) {
    if (surface.is_removed(edge)) continue;
    const Halfedge halfedge = surface.halfedge(edge);
    const bool lined = traced.feature_degree(surface.source(halfedge)) > 0 &&
                       traced.feature_degree(surface.target(halfedge)) > 0;
    if (lined || !CGAL::Euler::does_satisfy_link_condition(edge, surface)) continue;
    CollapseRing ring(traced, halfedge, surface.point(surface.target(halfedge)));
    if (!ring.keeps(original, 0.0)) continue;
    ring.apply(traced, CGAL::Euler::collapse_edge(edge, surface));
  }
}

// Every vertex of the original is remembered by one triangle, and one line, that it lies on.
void remember_vertices(TracedSurface& traced) {
  for (const Vertex vertex : traced.surface.vertices()) {
    bool on_face = false;
    bool on_line = false;
    for (const Halfedge in : CGAL::halfedges_around_target(vertex, traced.surface)) {
      if (!on_line && traced.is_feature(in)) {
        traced.along[traced.surface.edge(in)].push_back(vertex.idx());
        on_line = true;
      }
      if (on_face || traced.surface.is_border(in)) continue;
      traced.on[traced.surface.face(in)].push_back(vertex.idx());
      on_face = true;
    }
  }
}

void mark_features(TracedSurface& traced, SimplifyOriginal& original) {
  const Mesh& mesh = original.mesh;
  original.samples.reserve(5 * mesh.positions.size() + mesh.triangles.size());
  for (const auto& p : mesh.positions) original.samples.emplace_back(p[0], p[1], p[2]);
  const auto sample_on = [&](std::uint32_t triangle, const Vector& point) {
    traced.on[TracedSurface::Face(triangle)].push_back(
        static_cast<std::uint32_t>(original.samples.size()));
    original.samples.push_back(point);
  };
  for_each_edge(edge_uses(mesh), [&](std::span<const EdgeUse> sides) {
    const auto [low, high, triangle, corner, rising] = sides[0];
    sample_on(triangle, 0.5 * (original.samples[low] + original.samples[high]));
    if (!is_feature_edge(mesh, sides)) return;
    traced.feature[traced.surface.edge(traced.surface.halfedge(Vertex(low), Vertex(high)))] = true;
  });
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vector sum = original.samples[a] + original.samples[b] + original.samples[c];
    sample_on(t, sum / 3.0);
    traced.chart[TracedSurface::Face(t)] = original.charts.part_of[t];
  }
  remember_vertices(traced);
}

std::shared_ptr<SimplifyOriginal> keep_original(const Mesh& mesh) {
  auto original = std::make_shared<SimplifyOriginal>();
  original->mesh = mesh;
  original->charts = uv_charts(mesh, edge_uses(mesh));
  std::vector<TriangleCorners> surface;
  for (const auto& triangle : mesh.triangles) {
    std::array<Point, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = cgal_point(mesh.positions[triangle[i]]);
    if (CGAL::collinear(p[0], p[1], p[2])) continue;
    surface.push_back({vector_of(p[0]), vector_of(p[1]), vector_of(p[2])});
  }
  original->surface = std::make_unique<TriangleSearch>(std::move(surface));
  original->uvs = std::make_unique<UvSource>(original->mesh, original->charts);
  return original;
}

}  // namespace

struct MeshSimplifier::State {
  std::string what;
  std::shared_ptr<const SimplifyOriginal> original;
  TracedSurface traced;
};

MeshSimplifier::MeshSimplifier(std::unique_ptr<State> state) : state_(std::move(state)) {}
MeshSimplifier::MeshSimplifier(const MeshSimplifier& other)
    : state_(std::make_unique<State>(*other.state_)) {}
MeshSimplifier::MeshSimplifier(MeshSimplifier&& other) noexcept = default;
MeshSimplifier& MeshSimplifier::operator=(MeshSimplifier&& other) noexcept = default;
MeshSimplifier::~MeshSimplifier() = default;

Result<MeshSimplifier> MeshSimplifier::create(const Mesh& mesh, const std::string& what) {
  return guard_cgal(what + ": simplifying the mesh", [&]() -> Result<MeshSimplifier> {
    auto surface = cgal_surface(mesh);
    if (!surface) return fail(ErrorKind::kInput, "{}: the mesh is not an oriented manifold", what);
    const auto original = keep_original(mesh);
    auto state = std::make_unique<State>(
        State{.what = what, .original = original, .traced = TracedSurface(std::move(*surface))});
    mark_features(state->traced, *original);
    collapse_edges_without_length(state->traced, *original);
    return MeshSimplifier(std::move(state));
  });
}

Status MeshSimplifier::simplify(double tolerance_m) {
  return guard_cgal(state_->what + ": simplifying the mesh", [&]() -> Status {
    TracedSurface& traced = state_->traced;
    lock_edges_without_length(traced);
    Pending pending;
    sms::edge_collapse(traced.surface, NeverStop{},
                       CGAL::parameters::edge_is_constrained_map(traced.locked)
                           .get_cost(sms::LindstromTurk_cost<CgalSurface>())
                           .get_placement(Placement{&traced})
                           .filter(Filter{&traced, state_->original.get(), tolerance_m, &pending})
                           .visitor(Tracer(&traced, &pending)));
    return {};
  });
}

std::size_t MeshSimplifier::triangle_count() const {
  return state_->traced.surface.number_of_faces();
}

Mesh MeshSimplifier::mesh() const {
  const TracedSurface& traced = state_->traced;
  const CgalSurface& surface = traced.surface;
  const SimplifyOriginal& original = *state_->original;
  Mesh out;
  out.slot_names = original.mesh.slot_names;
  out.smooth_angle_rad = original.mesh.smooth_angle_rad;
  std::vector<std::uint32_t> chart_slots(original.charts.count, 0);
  for (std::size_t t = 0; t < original.mesh.triangles.size(); ++t) {
    chart_slots[original.charts.part_of[t]] = original.mesh.triangle_slots[t];
  }
  std::vector<std::uint32_t> number(surface.num_vertices(), 0);
  for (const Vertex vertex : surface.vertices()) {
    number[vertex.idx()] = static_cast<std::uint32_t>(out.positions.size());
    const Point& p = surface.point(vertex);
    out.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  for (const auto face : surface.faces()) {
    std::array<Vertex, 3> corners;
    std::size_t i = 0;
    for (const Vertex v : CGAL::vertices_around_face(surface.halfedge(face), surface)) {
      corners[i++] = v;
    }
    std::array<Vector, 3> at;
    for (i = 0; i < 3; ++i) at[i] = vector_of(surface.point(corners[i]));
    const Vector centre = (at[0] + at[1] + at[2]) / 3.0;
    out.triangles.push_back(
        {number[corners[0].idx()], number[corners[1].idx()], number[corners[2].idx()]});
    out.triangle_slots.push_back(chart_slots[traced.chart[face]]);
    for (const Vector& corner : at) {
      constexpr double kInward = 0.02;  // enough to tell the sides of a seam
      out.corner_uvs.push_back(
          original.uvs->uv_at(traced.chart[face], corner, corner + kInward * (centre - corner)));
    }
  }
  return out;
}

}  // namespace seedframe
