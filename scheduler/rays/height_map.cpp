#include "rays/height_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace seedframe {

namespace {

constexpr double kNoHeight = std::numeric_limits<double>::quiet_NaN();

}  // namespace

HeightMap::HeightMap(const Mesh& mesh, const Eigen::Affine3d& world_from_object, Side side)
    : heights_(static_cast<std::size_t>(kHeightSamples) * kHeightSamples, kNoHeight) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(mesh.positions.size());
  for (const std::array<float, 3>& p : mesh.positions) {
    points.push_back(world_from_object * Eigen::Vector3d(p[0], p[1], p[2]));
  }
  low_ = high_ = points.empty() ? Eigen::Vector2d::Zero() : Eigen::Vector2d(points[0].head<2>());
  for (const Eigen::Vector3d& point : points) {
    low_ = low_.cwiseMin(point.head<2>());
    high_ = high_.cwiseMax(point.head<2>());
  }
  step_ = (high_ - low_) / kHeightSamples;
  if (step_.minCoeff() <= 0.0) return;  // seen edge on
  for (const auto& triangle : mesh.triangles) {
    add_triangle(points[triangle[0]], points[triangle[1]], points[triangle[2]], side);
  }
}

double& HeightMap::cell(int row, int column) {
  return heights_[static_cast<std::size_t>(row) * kHeightSamples +
                  static_cast<std::size_t>(column)];
}

void HeightMap::add_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             const Eigen::Vector3d& c, Side side) {
  const Eigen::Vector2d ab = (b - a).head<2>();
  const Eigen::Vector2d ac = (c - a).head<2>();
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  if (area == 0.0) return;
  const auto first = [&](int axis) {
    const double least = std::min({a[axis], b[axis], c[axis]});
    return std::clamp(static_cast<int>(std::ceil((least - low_[axis]) / step_[axis] - 0.5)), 0,
                      kHeightSamples);
  };
  const auto last = [&](int axis) {
    const double most = std::max({a[axis], b[axis], c[axis]});
    return std::clamp(static_cast<int>(std::floor((most - low_[axis]) / step_[axis] - 0.5)), -1,
                      kHeightSamples - 1);
  };
  for (int row = first(1); row <= last(1); ++row) {
    const double y = low_.y() + (row + 0.5) * step_.y() - a.y();
    for (int column = first(0); column <= last(0); ++column) {
      const double x = low_.x() + (column + 0.5) * step_.x() - a.x();
      const double u = (x * ac.y() - y * ac.x()) / area;
      const double v = (ab.x() * y - ab.y() * x) / area;
      if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
      const double height = a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z());
      double& known = cell(row, column);
      const bool replaces =
          std::isnan(known) || (side == Side::kAbove ? height > known : height < known);
      if (replaces) known = height;
    }
  }
}

double HeightMap::at(double x, double y) const {
  if (x < low_.x() || x > high_.x() || y < low_.y() || y > high_.y() || step_.minCoeff() <= 0.0) {
    return kNoHeight;
  }
  const auto index = [&](double value, int axis) {
    return std::min(static_cast<int>((value - low_[axis]) / step_[axis]), kHeightSamples - 1);
  };
  return heights_[static_cast<std::size_t>(index(y, 1)) * kHeightSamples +
                  static_cast<std::size_t>(index(x, 0))];
}

double overlap_of(const HeightMap& lower, const HeightMap& upper) {
  if (lower.high_x() < upper.low_x() || upper.high_x() < lower.low_x() ||
      lower.high_y() < upper.low_y() || upper.high_y() < lower.low_y()) {
    return 0.0;
  }
  double overlap = 0.0;
  // From both sides: a needle under a plate has its cells, and so has a plate under a needle.
  upper.for_each([&](double x, double y, double bottom) {
    const double top = lower.at(x, y);
    if (top - bottom > overlap) overlap = top - bottom;  // never with NaN
  });
  lower.for_each([&](double x, double y, double top) {
    const double bottom = upper.at(x, y);
    if (top - bottom > overlap) overlap = top - bottom;
  });
  return overlap;
}

}  // namespace seedframe
