#include "mesh/stable_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include <CGAL/convex_hull_3.h>

#include "base/portable_math.h"
#include "mesh/cgal_guard.h"
#include "mesh/cgal_surface.h"
#include "mesh/mesh_edges.h"

namespace seedframe {
namespace {

constexpr double kFlat = 1e-4;            // of the size
constexpr double kSameDirection = 0.996;  // cosine of 5 degrees
constexpr double kLeastProbability = 1e-4;
constexpr double kLean = 0.05;  // tangent of 3 degrees
constexpr std::size_t kNoFace = SIZE_MAX;

struct Hull {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::size_t, 3>> triangles;  ///< anticlockwise from outside
  double size = 0.0;
};

Result<Hull> hull_of(const Mesh& mesh, const Eigen::Vector3d& scale) {
  return guard_cgal("the convex hull", [&]() -> Result<Hull> {
    std::vector<CgalKernel::Point_3> points;
    points.reserve(mesh.positions.size());
    for (const auto& at : mesh.positions) {
      points.push_back(
          cgal_point(Eigen::Vector3d(scale.cwiseProduct(Eigen::Vector3d(at[0], at[1], at[2])))));
    }
    CgalSurface surface;
    CGAL::convex_hull_3(points.begin(), points.end(), surface);
    Hull hull;
    Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector3d high = -low;
    for (const auto vertex : surface.vertices()) {
      hull.points.push_back(vector_of(surface.point(vertex)));
      low = low.cwiseMin(hull.points.back());
      high = high.cwiseMax(hull.points.back());
    }
    hull.size = hull.points.empty() ? 0.0 : (high - low).norm();
    for (const auto face : surface.faces()) {
      std::vector<std::size_t> corners;
      for (const auto vertex : surface.vertices_around_face(surface.halfedge(face))) {
        corners.push_back(static_cast<std::size_t>(vertex));
      }
      for (std::size_t i = 2; i < corners.size(); ++i) {
        hull.triangles.push_back({corners[0], corners[i - 1], corners[i]});
      }
    }
    if (hull.triangles.size() < 4) return fail(ErrorKind::kInput, "the mesh is flat");
    return hull;
  });
}

/// Of tetrahedra over triangles, from the origin.
struct Mass {
  double volume = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const double part = a.dot(b.cross(c)) / 6.0;
    volume += part;
    moment += part / 4.0 * (a + b + c);
  }
};

Mass mass_of(const Hull& hull, const Eigen::Vector3d& origin) {
  Mass mass;
  for (const auto& [a, b, c] : hull.triangles) {
    mass.add(hull.points[a] - origin, hull.points[b] - origin, hull.points[c] - origin);
  }
  return mass;
}

/// Of what the mesh encloses; of its hull, if the mesh is not closed or inside out.
Eigen::Vector3d centre_of_mass(const Mesh& mesh, const Eigen::Vector3d& scale, const Hull& hull) {
  const Eigen::Vector3d origin = hull.points.front();
  const Mass whole = mass_of(hull, origin);
  Mass own;
  const auto at = [&](std::uint32_t vertex) {
    const auto& p = mesh.positions[vertex];
    return Eigen::Vector3d(scale.cwiseProduct(Eigen::Vector3d(p[0], p[1], p[2])) - origin);
  };
  for (const auto& [a, b, c] : mesh.triangles) own.add(at(a), at(b), at(c));
  constexpr double kHardly = 1e-3;
  bool closed = true;
  for_each_edge(edge_uses(mesh), [&](std::span<const EdgeUse> sides) {
    closed = closed && is_manifold_edge(sides);
  });
  const bool solid =
      closed && own.volume > kHardly * whole.volume && own.volume <= 1.001 * whole.volume;
  const Mass& mass = solid ? own : whole;
  return origin + mass.moment / mass.volume;
}

/// A. van Oosterom and J. Strackee, "The solid angle of a plane triangle", 1983.
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double above = a.dot(b.cross(c));
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::abs(portable::atan2(above, below));
}

/// The hull's triangles, put together to faces that are flat.
class Faces {
 public:
  Faces(const Hull& hull, const Eigen::Vector3d& centre) : hull_(hull), centre_(centre) {
    measure_triangles();
    grow_faces();
    weigh_faces();
  }

  std::vector<StableFace> stable() const;

 private:
  void measure_triangles();
  void grow_faces();
  void weigh_faces();
  bool fits(std::size_t triangle, std::size_t seed) const;

  const Hull& hull_;
  Eigen::Vector3d centre_;
  std::vector<Eigen::Vector3d> normals_;  ///< of triangles, of unit length
  std::vector<double> areas_;             ///< of triangles, doubled
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> triangle_of_edge_;
  std::vector<std::size_t> face_of_;  ///< by triangle
  std::vector<std::size_t> seeds_;    ///< by face: its largest triangle
  std::vector<double> angles_;        ///< by face: its solid angle
  std::vector<std::size_t> next_;     ///< by face: on which one it tips; itself: it stands
};

void Faces::measure_triangles() {
  for (std::size_t t = 0; t < hull_.triangles.size(); ++t) {
    const auto& [a, b, c] = hull_.triangles[t];
    const Eigen::Vector3d normal =
        (hull_.points[b] - hull_.points[a]).cross(hull_.points[c] - hull_.points[a]);
    areas_.push_back(normal.norm());
    normals_.push_back(areas_.back() > 0.0 ? Eigen::Vector3d(normal / areas_.back())
                                           : Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < 3; ++i) {
      triangle_of_edge_[{hull_.triangles[t][i], hull_.triangles[t][(i + 1) % 3]}] = t;
    }
  }
}

bool Faces::fits(std::size_t triangle, std::size_t seed) const {
  const Eigen::Vector3d& normal = normals_[seed];
  const Eigen::Vector3d& on_plane = hull_.points[hull_.triangles[seed][0]];
  const auto& corners = hull_.triangles[triangle];
  const bool flat = std::all_of(corners.begin(), corners.end(), [&](std::size_t corner) {
    return std::abs(normal.dot(hull_.points[corner] - on_plane)) <= kFlat * hull_.size;
  });
  return flat && (areas_[triangle] == 0.0 || normals_[triangle].dot(normal) >= kSameDirection);
}

void Faces::grow_faces() {
  std::vector<std::size_t> order(hull_.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return areas_[a] > areas_[b]; });
  face_of_.assign(hull_.triangles.size(), kNoFace);
  for (const std::size_t seed : order) {
    if (face_of_[seed] != kNoFace) continue;
    face_of_[seed] = seeds_.size();
    std::vector<std::size_t> grown = {seed};
    for (std::size_t i = 0; i < grown.size(); ++i) {
      for (std::size_t side = 0; side < 3; ++side) {
        const auto& corners = hull_.triangles[grown[i]];
        const std::size_t beside = triangle_of_edge_.at({corners[(side + 1) % 3], corners[side]});
        if (face_of_[beside] != kNoFace || !fits(beside, seed)) continue;
        face_of_[beside] = seeds_.size();
        grown.push_back(beside);
      }
    }
    seeds_.push_back(seed);
  }
}

void Faces::weigh_faces() {
  angles_.assign(seeds_.size(), 0.0);
  next_.resize(seeds_.size());
  std::iota(next_.begin(), next_.end(), std::size_t{0});
  std::vector<double> heights;  // of the centre over each face
  for (const std::size_t seed : seeds_) {
    heights.push_back(normals_[seed].dot(hull_.points[hull_.triangles[seed][0]] - centre_));
  }
  std::vector<double> farthest(seeds_.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < hull_.triangles.size(); ++t) {
    const std::size_t face = face_of_[t];
    const auto& corners = hull_.triangles[t];
    angles_[face] +=
        solid_angle(hull_.points[corners[0]] - centre_, hull_.points[corners[1]] - centre_,
                    hull_.points[corners[2]] - centre_);
    for (std::size_t side = 0; side < 3; ++side) {
      const std::size_t from = corners[side];
      const std::size_t to = corners[(side + 1) % 3];
      const std::size_t beside = face_of_[triangle_of_edge_.at({to, from})];
      const Eigen::Vector3d edge = hull_.points[to] - hull_.points[from];
      const double length = edge.norm();
      const bool sinks = heights[beside] < heights[face] - kFlat * hull_.size;
      if (beside == face || length == 0.0 || !sinks) continue;
      const Eigen::Vector3d outwards = edge.cross(normals_[seeds_[face]]) / length;
      const double beyond = outwards.dot(centre_ - hull_.points[from]);  // that of the centre
      if (beyond <= std::max(farthest[face], -kLean * heights[face])) continue;
      farthest[face] = beyond;
      next_[face] = beside;
    }
  }
}

std::vector<StableFace> Faces::stable() const {
  std::vector<double> caught(seeds_.size(), 0.0);
  for (std::size_t face = 0; face < seeds_.size(); ++face) {
    std::size_t on = face;
    while (next_[on] != on) on = next_[on];  // the centre sinks with each tip
    caught[on] += angles_[face] / (4.0 * portable::kPi);
  }
  std::vector<StableFace> faces;
  double sum = 0.0;
  for (std::size_t face = 0; face < seeds_.size(); ++face) {
    if (caught[face] < kLeastProbability) continue;
    faces.push_back({normals_[seeds_[face]], caught[face]});
    sum += caught[face];
  }
  for (StableFace& face : faces) face.probability /= sum;
  std::stable_sort(faces.begin(), faces.end(), [](const StableFace& a, const StableFace& b) {
    return a.probability > b.probability;
  });
  return faces;
}

}  // namespace

Result<std::vector<StableFace>> stable_faces(const Mesh& mesh, const Eigen::Vector3d& scale) {
  const Result<Hull> hull = hull_of(mesh, scale);
  if (!hull) return forward_error(hull);
  std::vector<StableFace> faces = Faces(*hull, centre_of_mass(mesh, scale, *hull)).stable();
  if (faces.empty()) return fail(ErrorKind::kInput, "no face of its hull is one to stand on");
  return faces;
}

Eigen::Matrix3d standing_on(const StableFace& face) {
  Eigen::Matrix3d first = Eigen::Matrix3d::Identity();
  Eigen::Vector3d normal = face.normal;
  if (normal.z() > 0.0) {  // half a turn first, so that what is left is no more than a quarter
    first.diagonal() << 1.0, -1.0, -1.0;
    normal = first * normal;
  }
  // About normal × (0, 0, -1), by the angle whose cosine is -normal.z.
  const Eigen::Vector3d axis(-normal.y(), normal.x(), 0.0);
  Eigen::Matrix3d cross;
  cross << 0, 0, axis.y(), 0, 0, -axis.x(), -axis.y(), axis.x(), 0;
  return (Eigen::Matrix3d::Identity() + cross + cross * cross / (1.0 - normal.z())) * first;
}

}  // namespace seedframe
