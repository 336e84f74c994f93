#include "assets/symmetry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/portable_math.h"
#include "mesh/mesh_measure.h"
#include "mesh/triangle_search.h"

namespace seedframe {
namespace {

constexpr std::size_t kMostPoints = 4000;
constexpr int kHighestOrder = 36;
constexpr std::size_t kMostRotations = 120;
// Sine of the angle between axes, or rotations, that count as one: below half of the finest
// rotation's 10°, above what principal axes are off where their moments are nearly equal.
constexpr double kSameAxis = 0.06;

/// Rodrigues' formula.
Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle_rad) {
  const double cosine = portable::cos(angle_rad), sine = portable::sin(angle_rad);
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Eigen::Matrix3d::Identity() + sine * cross + (1.0 - cosine) * cross * cross;
}

bool are_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() < kSameAxis;
}

bool are_equal(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return (a - b).cwiseAbs().maxCoeff() < kSameAxis;
}

class SymmetrySearch {
 public:
  SymmetrySearch(const Mesh& mesh, double tolerance_m)
      : measures_(measure_mesh(mesh)),
        tolerance2_(tolerance_m * tolerance_m),
        search_(triangles_of(mesh)) {
    const std::size_t all = mesh.positions.size() + mesh.triangles.size();
    const std::size_t step = std::max<std::size_t>(1, all / kMostPoints);
    for (std::size_t i = 0; i < all; i += step) points_.push_back(point(mesh, i));
  }

  Symmetries find() const {
    Symmetries found;
    found.centre = measures_.centroid;
    std::vector<Eigen::Matrix3d> generators;
    for (const Eigen::Vector3d& axis : candidates()) {
      if (turns_freely_about(axis)) {
        found.axes.push_back(axis);
      } else if (const auto rotation = finest_about(axis)) {
        generators.push_back(*rotation);
      }
    }
    if (found.axes.size() > 1) {  // a sphere: three tell it
      found.axes.resize(std::min<std::size_t>(found.axes.size(), 3));
      return found;
    }
    if (found.axes.size() == 1) {
      const auto over =
          std::find_if(generators.begin(), generators.end(), [&](const Eigen::Matrix3d& rotation) {
            return (rotation * found.axes[0] + found.axes[0]).norm() < kSameAxis;
          });
      if (over != generators.end()) found.rotations.push_back(*over);
      return found;
    }
    // The asset's own axes are exact, principal ones are about there: they come last, and only if
    // they lead to something new.
    std::vector<Eigen::Matrix3d> used;
    for (const Eigen::Matrix3d& generator : generators) {
      const bool known =
          std::any_of(found.rotations.begin(), found.rotations.end(),
                      [&](const Eigen::Matrix3d& other) { return are_equal(generator, other); });
      if (known) continue;
      used.push_back(generator);
      found.rotations = group_of(used);
      if (found.rotations.empty()) break;
    }
    return found;
  }

 private:
  static std::vector<TriangleCorners> triangles_of(const Mesh& mesh) {
    std::vector<TriangleCorners> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles.push_back({vertex(mesh, a), vertex(mesh, b), vertex(mesh, c)});
    }
    return triangles;
  }
  static Eigen::Vector3d vertex(const Mesh& mesh, std::size_t index) {
    const std::array<float, 3>& at = mesh.positions[index];
    return {at[0], at[1], at[2]};
  }
  /// Vertices first, then centres of triangles.
  static Eigen::Vector3d point(const Mesh& mesh, std::size_t index) {
    if (index < mesh.positions.size()) return vertex(mesh, index);
    const auto& [a, b, c] = mesh.triangles[index - mesh.positions.size()];
    return (vertex(mesh, a) + vertex(mesh, b) + vertex(mesh, c)) / 3.0;
  }

  std::vector<Eigen::Vector3d> candidates() const {
    std::vector<Eigen::Vector3d> axes = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(),
                                         Eigen::Vector3d::UnitY()};
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d axis = measures_.principal_axes.col(i);
      const bool known = std::any_of(axes.begin(), axes.end(), [&](const Eigen::Vector3d& other) {
        return are_parallel(axis, other);
      });
      if (!known) axes.push_back(axis);
    }
    return axes;
  }

  /// Calls look(point) with every sample turned, and turned back, until one is refused.
  template <class Look>
  bool for_all_turned(const Eigen::Matrix3d& rotation, const Look& look) const {
    const Eigen::Matrix3d back = rotation.transpose();
    return std::all_of(points_.begin(), points_.end(), [&](const Eigen::Vector3d& point) {
      const Eigen::Vector3d arm = point - measures_.centroid;
      return look(measures_.centroid + rotation * arm) && look(measures_.centroid + back * arm);
    });
  }
  bool is_symmetry(const Eigen::Matrix3d& rotation) const {
    return for_all_turned(rotation, [&](const Eigen::Vector3d& point) {
      return search_.any_within(point, tolerance2_);
    });
  }
  /// Metres that the furthest sample is from the surface.
  double deviation(const Eigen::Matrix3d& rotation) const {
    double most2 = 0.0;
    for_all_turned(rotation, [&](const Eigen::Vector3d& point) {
      most2 = std::max(most2, search_.nearest(point).squared_distance);
      return true;
    });
    return std::sqrt(most2);
  }
  bool turns_freely_about(const Eigen::Vector3d& axis) const {
    // No part but one that is round survives all of these.
    constexpr std::array<double, 4> kAnglesRad = {0.1, 0.37, 1.0, 2.3};
    return std::all_of(kAnglesRad.begin(), kAnglesRad.end(), [&](double angle_rad) {
      return is_symmetry(rotation_about(axis, angle_rad));
    });
  }
  /// Of the highest order, of those that fit about as well as the one that fits best: a hexagon is
  /// nearly a heptagon, too.
  std::optional<Eigen::Matrix3d> finest_about(const Eigen::Vector3d& axis) const {
    constexpr double kAsWell = 1.25, kWellEnough = 0.5;       // of the tolerance
    std::vector<std::pair<double, Eigen::Matrix3d>> fitting;  // the highest order first
    for (int order = kHighestOrder; order > 1; --order) {
      const Eigen::Matrix3d rotation = rotation_about(axis, 2.0 * std::numbers::pi / order);
      if (is_symmetry(rotation)) fitting.emplace_back(deviation(rotation), rotation);
    }
    if (fitting.empty()) return std::nullopt;
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    const double best = std::min_element(fitting.begin(), fitting.end(), less)->first;
    const double most = std::max(kAsWell * best, kWellEnough * std::sqrt(tolerance2_));
    return std::find_if(fitting.begin(), fitting.end(),
                        [&](const auto& each) { return each.first <= most; })
        ->second;
  }

  /// All products, without the identity; none if there is no end to them.
  static std::vector<Eigen::Matrix3d> group_of(const std::vector<Eigen::Matrix3d>& generators) {
    std::vector<Eigen::Matrix3d> group = {Eigen::Matrix3d::Identity()};
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const Eigen::Matrix3d& generator : generators) {
        const Eigen::Matrix3d product = generator * group[i];
        const bool known =
            std::any_of(group.begin(), group.end(),
                        [&](const Eigen::Matrix3d& other) { return are_equal(product, other); });
        if (!known) group.push_back(product);
      }
      if (group.size() > kMostRotations + 1) return {};
    }
    group.erase(group.begin());
    return group;
  }

  MeshMeasures measures_;
  double tolerance2_;
  TriangleSearch search_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

Symmetries find_symmetries(const Mesh& mesh, double tolerance_m) {
  return SymmetrySearch(mesh, tolerance_m).find();
}

}  // namespace seedframe
