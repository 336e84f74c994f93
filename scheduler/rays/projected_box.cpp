#include "rays/projected_box.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace seedframe {
namespace {

/// What float's arithmetic may be off by, and a hundred times more: as a share of depths, and of
/// distances from the camera.
constexpr double kMargin = 1e-5;

using Corners = std::array<Eigen::Vector3d, 8>;

/// Points of the camera's frame whose projections enclose that of the part of a box that is ahead
/// of the near plane: its corners, and where its edges pass through the plane.
std::vector<Eigen::Vector3d> points_ahead(const Corners& corners, double near) {
  std::vector<Eigen::Vector3d> ahead;
  const auto is_ahead = [&](std::size_t corner) { return -corners[corner].z() > near; };
  for (std::size_t from = 0; from < corners.size(); ++from) {
    if (is_ahead(from)) ahead.push_back(corners[from]);
    // Along an edge one coordinate of the box changes, and with it one bit of the corner's index.
    for (const std::size_t bit : {1U, 2U, 4U}) {
      const std::size_t to = from ^ bit;
      if (!is_ahead(from) || is_ahead(to)) continue;
      const double share = (corners[from].z() + near) / (corners[from].z() - corners[to].z());
      ahead.emplace_back(corners[from] + share * (corners[to] - corners[from]));
    }
  }
  return ahead;
}

/// The pixels of the canvas onto which the hull of points may project.
PixelRect projected_rect(const std::vector<Eigen::Vector3d>& points, const PixelCamera& camera) {
  if (points.empty()) return {};
  const PixelRect canvas = enlarged_canvas(camera);
  std::array<double, 2> low = {1e300, 1e300};
  std::array<double, 2> high = {-1e300, -1e300};
  for (const Eigen::Vector3d& seen : points) {
    const double x = camera.center_px[0] + camera.focal_px[0] * seen.x() / -seen.z();
    const double y = camera.center_px[1] - camera.focal_px[1] * seen.y() / -seen.z();
    low = {std::min(low[0], x), std::min(low[1], y)};
    high = {std::max(high[0], x), std::max(high[1], y)};
  }
  const auto clamped = [](double value, int least, int size) {
    return static_cast<int>(
        std::clamp(value, static_cast<double>(least), static_cast<double>(least + size)));
  };
  // A pixel more on each side for what rounds.
  const int left = clamped(std::floor(low[0]) - 1, canvas.x, canvas.width);
  const int right = clamped(std::ceil(high[0]) + 2, canvas.x, canvas.width);
  const int top = clamped(std::floor(low[1]) - 1, canvas.y, canvas.height);
  const int bottom = clamped(std::ceil(high[1]) + 2, canvas.y, canvas.height);
  return {left, top, right - left, bottom - top};
}

}  // namespace

ProjectedBox::ProjectedBox(const BoundingBox& box, const Eigen::Affine3d& camera_from_object,
                           const PixelCamera& camera)
    : nearest_((1.0 + kMargin) / camera.clip_start_m) {
  Corners corners = box.corners();
  double farthest = 0.0;
  for (Eigen::Vector3d& corner : corners) {
    corner = camera_from_object * corner;
    farthest = std::max(farthest, corner.norm());
    reaches_behind_ = reaches_behind_ || -corner.z() <= camera.clip_start_m;
  }
  rect_ = projected_rect(points_ahead(corners, camera.clip_start_m), camera);
  const Eigen::Affine3d object_from_camera = camera_from_object.inverse();
  const double margin = kMargin * farthest * object_from_camera.linear().norm();
  if (!std::isfinite(margin)) return;  // a flattened object has no inverse
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d normal = object_from_camera.linear().row(axis);
    const double origin = object_from_camera.translation()[axis];
    add_plane(normal, box.high[axis] + margin - origin, camera);
    add_plane(-normal, origin - (box.low[axis] - margin), camera);
  }
}

/// The box is where normal · point ≤ offset.
void ProjectedBox::add_plane(const Eigen::Vector3d& normal, double offset,
                             const PixelCamera& camera) {
  // A ray (x, y, -1) t is on the plane where 1 / t = normal · (x, y, -1) / offset.
  const Eigen::Vector3d scaled = normal / offset;
  if (!scaled.allFinite()) return;  // the camera is in the plane
  const double per_column = scaled.x() / camera.focal_px[0];
  const double per_row = -scaled.y() / camera.focal_px[1];
  const double at_origin =
      -scaled.z() - per_column * camera.center_px[0] - per_row * camera.center_px[1];
  (offset < 0.0 ? entered_ : left_).push_back({at_origin, per_column, per_row});
}

ProjectedBox::Columns ProjectedBox::columns_met(int row) const {
  double begin = rect_.x;
  double end = rect_.end_x() - 1;
  // Rays leave the box no nearer than they enter it, each of which is linear in the column.
  const auto require = [&](double at_origin, double per_column) {
    const double zero = -at_origin / per_column;
    if (per_column > 0.0) begin = std::max(begin, zero);
    if (per_column < 0.0) end = std::min(end, zero);
    if (per_column == 0.0 && at_origin < 0.0) end = begin - 1.0;
  };
  for (const Plane& left : left_) require(nearest_ - left.at(0, row), -left.per_column);
  for (const Plane& entered : entered_) {
    require(entered.at(0, row), entered.per_column);
    for (const Plane& left : left_) {
      require(entered.at(0, row) - left.at(0, row), entered.per_column - left.per_column);
    }
  }
  if (!(begin <= end)) return {};
  // Whole columns of both sides: what rounds must not cost a pixel.
  const Columns columns{static_cast<int>(std::floor(begin)), static_cast<int>(std::ceil(end)) + 1};
  return {std::max(columns.begin, rect_.x), std::min(columns.end, rect_.end_x())};
}

void ProjectedBox::find_met_before(int row, int begin, int count, const float* first_hit,
                                   std::uint8_t* met) const {
  constexpr auto kAtMost = static_cast<float>(1.0 + kMargin);
  // All loops but the last have a constant length, so that the compiler makes them vectors.
  constexpr int kColumns = 32;
  std::array<float, kColumns> leave;  // one over the depths at which rays leave the box, at most
  for (int done = 0; done < count; done += kColumns) {
    leave.fill(0.0F);
    for (const Plane& plane : left_) {
      const auto first = static_cast<float>(plane.at(begin + done, row));
      const auto step = static_cast<float>(plane.per_column);
      for (int i = 0; i < kColumns; ++i) {
        const float depth = first + step * static_cast<float>(i);
        leave[i] = leave[i] > depth ? leave[i] : depth;
      }
    }
    const int columns = std::min(kColumns, count - done);
    for (int i = 0; i < columns; ++i) met[done + i] = first_hit[done + i] * leave[i] <= kAtMost;
  }
}

}  // namespace seedframe
