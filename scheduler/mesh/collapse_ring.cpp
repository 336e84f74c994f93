#include "mesh/collapse_ring.h"

#include <algorithm>
#include <utility>

#include "mesh/triangle_distance.h"

namespace seedframe {
namespace {

using Vector = Eigen::Vector3d;

void append(TracedSurface::Samples& to, const TracedSurface::Samples& from) {
  to.insert(to.end(), from.begin(), from.end());
}

// Gives each sample to the part that is nearest now; false if one is too far from all of them.
// `bounds` gives a part's box: most parts are farther than the one that held the sample before.
template <class Part, class SquaredDistance, class Bounds>
bool hand_out(const TracedSurface::Samples& loose, std::vector<Part>& parts,
              TracedSurface::Samples Part::*held, const SimplifyOriginal& original,
              double squared_tolerance, const SquaredDistance& squared_distance,
              const Bounds& bounds) {
  if (parts.empty()) return loose.empty();
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<TracedSurface::Samples> before;
  for (Part& part : parts) {
    boxes.push_back(bounds(part));
    before.push_back(std::exchange(part.*held, {}));
  }
  const auto hand_out_all = [&](const TracedSurface::Samples& samples, std::size_t holder) {
    return std::all_of(samples.begin(), samples.end(), [&](std::uint32_t sample) {
      const Vector& p = original.samples[sample];
      std::size_t nearest = holder;
      double least = squared_distance(p, parts[holder]);
      for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i == holder || boxes[i].squaredExteriorDistance(p) >= least) continue;
        const double distance = squared_distance(p, parts[i]);
        if (distance >= least) continue;
        least = distance;
        nearest = i;
      }
      (parts[nearest].*held).push_back(sample);
      return least <= squared_tolerance;
    });
  };
  if (!hand_out_all(loose, 0)) return false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!hand_out_all(before[i], i)) return false;
  }
  return true;
}

}  // namespace

TracedSurface::TracedSurface(CgalSurface from)
    : surface(std::move(from)),
      feature(surface.add_property_map<Edge, bool>("e:feature", false).first),
      along(surface.add_property_map<Edge, Samples>("e:along").first),
      on(surface.add_property_map<Face, Samples>("f:on").first),
      chart(surface.add_property_map<Face, std::uint32_t>("f:chart", 0).first),
      locked(surface.add_property_map<Edge, bool>("e:locked", false).first) {}

std::size_t TracedSurface::feature_degree(Vertex vertex) const {
  std::size_t degree = 0;
  for (const Halfedge halfedge : CGAL::halfedges_around_target(vertex, surface)) {
    if (is_feature(halfedge)) ++degree;
  }
  return degree;
}

CollapseRing::CollapseRing(const TracedSurface& traced, TracedSurface::Halfedge halfedge,
                           const CgalKernel::Point_3& point)
    : traced_(traced), halfedge_(halfedge), point_(vector_of(point)) {
  collect(halfedge);
  collect(traced.surface.opposite(halfedge));
  collect_spokes(halfedge);
  collect_spokes(traced.surface.opposite(halfedge));
}

// The triangles around the halfedge's target, without the edge's own two, which vanish.
void CollapseRing::collect(TracedSurface::Halfedge halfedge) {
  const CgalSurface& surface = traced_.surface;
  const auto left = surface.face(halfedge);
  const auto right = surface.face(surface.opposite(halfedge));
  for (const auto in : CGAL::halfedges_around_target(halfedge, surface)) {
    const auto face = surface.face(in);
    if (face == CgalSurface::null_face() || face == left || face == right) continue;
    Triangle triangle;
    triangle.face = face;
    triangle.a = surface.target(surface.next(in));
    triangle.b = surface.source(in);
    triangle.at_a = vector_of(surface.point(triangle.a));
    triangle.at_b = vector_of(surface.point(triangle.b));
    triangle.before = vector_of(surface.point(surface.target(in)));
    triangle.chart = traced_.chart[face];
    triangles_.push_back(std::move(triangle));
  }
}

void CollapseRing::collect_spokes(TracedSurface::Halfedge halfedge) {
  const CgalSurface& surface = traced_.surface;
  for (const auto in : CGAL::halfedges_around_target(halfedge, surface)) {
    if (in == halfedge || !traced_.is_feature(in)) continue;
    const auto end = surface.source(in);
    spokes_.push_back({surface.edge(in), end, vector_of(surface.point(end)), {}});
  }
}

void CollapseRing::collect_samples() {
  const CgalSurface& surface = traced_.surface;
  for (Triangle& triangle : triangles_) triangle.on = traced_.on[triangle.face];
  for (Spoke& spoke : spokes_) spoke.along = traced_.along[spoke.edge];
  for (const auto side : {halfedge_, surface.opposite(halfedge_)}) {
    const auto face = surface.face(side);
    if (face != CgalSurface::null_face()) append(loose_on_, traced_.on[face]);
  }
  if (traced_.is_feature(halfedge_)) loose_along_ = traced_.along[surface.edge(halfedge_)];
}

bool CollapseRing::keeps(const SimplifyOriginal& original, double tolerance_m) {
  const double squared = tolerance_m * tolerance_m;
  // Most collapses fail by their shape alone; samples are many.
  if (!keeps_direction() || !stays_near_original(original, squared)) return false;
  collect_samples();
  return keeps_lines_near(original, squared) && keeps_original_near(original, squared);
}

bool CollapseRing::keeps_direction() const {
  constexpr double kLeastCosine = 0.25;
  return std::all_of(triangles_.begin(), triangles_.end(), [&](const Triangle& t) {
    const Vector side = t.at_b - t.at_a;
    const Vector before = side.cross(t.before - t.at_a);
    const Vector after = side.cross(point_ - t.at_a);
    if (before.squaredNorm() == 0.0) return true;  // flat already: it had no direction
    if (after.squaredNorm() == 0.0) return false;
    return before.dot(after) >= kLeastCosine * before.norm() * after.norm();
  });
}

bool CollapseRing::keeps_original_near(const SimplifyOriginal& original, double squared_tolerance) {
  if (triangles_.empty()) return false;
  return hand_out(
      loose_on_, triangles_, &Triangle::on, original, squared_tolerance,
      [this](const Vector& p, const Triangle& t) {
        return squared_distance_to_triangle(p, t.at_a, t.at_b, point_);
      },
      [this](const Triangle& t) {
        return Eigen::AlignedBox3d(t.at_a).extend(t.at_b).extend(point_);
      });
}

bool CollapseRing::keeps_lines_near(const SimplifyOriginal& original, double squared_tolerance) {
  return hand_out(
      loose_along_, spokes_, &Spoke::along, original, squared_tolerance,
      [this](const Vector& p, const Spoke& spoke) {
        return squared_distance_to_segment(p, spoke.at, point_);
      },
      [this](const Spoke& spoke) { return Eigen::AlignedBox3d(spoke.at).extend(point_); });
}

bool CollapseRing::stays_near_original(const SimplifyOriginal& original,
                                       double squared_tolerance) const {
  const auto is_near = [&](const Vector& p) {
    return original.surface->any_within(p, squared_tolerance);
  };
  if (!is_near(point_)) return false;
  return std::all_of(triangles_.begin(), triangles_.end(), [&](const Triangle& t) {
    return is_near(0.5 * (t.at_a + point_)) && is_near(0.5 * (t.at_b + point_)) &&
           is_near((t.at_a + t.at_b + point_) / 3.0);
  });
}

void CollapseRing::apply(TracedSurface& traced, TracedSurface::Vertex vertex) {
  const CgalSurface& surface = traced.surface;
  // CGAL is free to keep either of two merged edges and faces: they are told by their ends.
  for (const auto in : CGAL::halfedges_around_target(vertex, surface)) {
    const auto end = surface.source(in);
    const auto spoke = std::find_if(spokes_.begin(), spokes_.end(),
                                    [&](const Spoke& candidate) { return candidate.end == end; });
    const auto edge = surface.edge(in);
    traced.feature[edge] = spoke != spokes_.end();
    traced.along[edge] = spoke == spokes_.end() ? TracedSurface::Samples() : spoke->along;
    const auto face = surface.face(in);
    if (face == CgalSurface::null_face()) continue;
    for (Triangle& triangle : triangles_) {
      if (triangle.b != end || triangle.a != surface.target(surface.next(in))) continue;
      traced.chart[face] = triangle.chart;
      traced.on[face] = std::move(triangle.on);
      break;
    }
  }
}

}  // namespace seedframe
