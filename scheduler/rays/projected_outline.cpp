#include "rays/projected_outline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace seedframe {
namespace {

/// As a share of the distance of what is farthest away: some eighty times float's last bit. A ray
/// is taken to the object's frame and compared with a triangle's sides in a dozen operations.
constexpr double kRayError = 5e-6;

/// In pixels.
struct Projected {
  double x;
  double y;
};

/// Of numbers that an int can hold; std::floor is a call where there is no SSE 4.1.
int floor_of(double value) {
  const int whole = static_cast<int>(value);
  return whole - (static_cast<double>(whole) > value ? 1 : 0);
}
int ceil_of(double value) { return -floor_of(-value); }

/// The vertices of a mesh; `margin_px` is what rays may be off by. Empty when one is not between
/// the clips.
std::vector<Projected> project(const RayMesh::Tree& mesh, const Eigen::Affine3d& camera_from_object,
                               const PixelCamera& camera, double error_m, double& margin_px) {
  const auto& matrix = camera_from_object.matrix();
  const Eigen::RowVector4d across = camera.focal_px[0] * matrix.row(0);
  const Eigen::RowVector4d down = -camera.focal_px[1] * matrix.row(1);
  const Eigen::RowVector4d ahead = -matrix.row(2);
  std::vector<Projected> projected(mesh.vertex_count);
  double nearest = camera.clip_end_m;
  double farthest = 0.0;
  for (std::size_t i = 0; i < mesh.vertex_count; ++i) {
    const std::array<float, 3>& point = mesh.positions[i];
    const auto along = [&](const Eigen::RowVector4d& row) {
      return row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
    };
    const double depth = along(ahead);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
    const double inverse = 1.0 / depth;
    projected[i] = {camera.center_px[0] + along(across) * inverse,
                    camera.center_px[1] + along(down) * inverse};
  }
  if (nearest < camera.clip_start_m + error_m || farthest > camera.clip_end_m - error_m) return {};
  margin_px = std::max(camera.focal_px[0], camera.focal_px[1]) * error_m / nearest;
  return projected;
}

/// Whether triangles run clockwise in the image.
std::vector<std::uint8_t> clockwise_triangles(const RayMesh::Tree& mesh,
                                              const std::vector<Projected>& projected) {
  std::vector<std::uint8_t> clockwise(mesh.triangle_count);
  for (std::size_t i = 0; i < mesh.triangle_count; ++i) {
    const auto& [first, second, third] = mesh.triangles[i];
    const Projected &a = projected[first], &b = projected[second], &c = projected[third];
    clockwise[i] = (b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x) ? 1 : 0;
  }
  return clockwise;
}

/// Collects the edges of an outline, then says of every pixel whether it is inside.
class Outline {
 public:
  Outline(MaskDraft& draft, double margin_px)
      : draft_(draft), margin_(margin_px), turns_(draft.mask.size()) {}

  void add(const Projected& from, const Projected& to) {
    const Projected& top = from.y < to.y ? from : to;
    const Projected& bottom = from.y < to.y ? to : from;
    const PixelRect& rect = draft_.rect;
    const int first = row_from(top.y - margin_);
    const int last = row_from(bottom.y + margin_);
    const std::int32_t turn = from.y < to.y ? 1 : -1;
    const double slope = (bottom.x - top.x) / (bottom.y - top.y);
    for (int y = first; y < last; ++y) {
      const double x = top.x + slope * (y - top.y);
      if (y >= top.y && y < bottom.y) {
        const int column = column_from(x);
        if (column < rect.end_x()) turns_[index(column, y)] += turn;
      }
      keep_unknown(top, bottom, slope, x, y);
    }
  }

  /// Returns how many pixels are unknown.
  std::int64_t fill() {
    std::int64_t unknown = 0;
    std::size_t at = 0;
    for (int y = 0; y < draft_.rect.height; ++y) {
      int turns = 0;
      for (int x = 0; x < draft_.rect.width; ++x, ++at) {
        turns += turns_[at];
        std::uint8_t& pixel = draft_.mask[at];
        if (pixel == kUnknown) pixel = turns != 0 ? kSet : 0;
        if (pixel == kNearOutline) {
          pixel = kUnknown;
          ++unknown;
        }
      }
    }
    return unknown;
  }

 private:
  static constexpr std::uint8_t kNearOutline = 3;

  /// What is unknown in a row near an edge. `x`: where its line is in the row.
  void keep_unknown(const Projected& top, const Projected& bottom, double slope, double x, int y) {
    // So far from the line along the row, and no farther than the edge's ends.
    const double reach = margin_ * (1.0 + std::abs(slope));
    const double left = std::min(top.x, bottom.x) - margin_;
    const double right = std::max(top.x, bottom.x) + margin_;
    // A level edge has no such place: NaN fails the comparisons.
    const double begin = x - reach > left ? x - reach : left;
    const double end = x + reach < right ? x + reach : right;
    const int after = std::max(column_from(begin), column_after(end));
    for (int column = column_from(begin); column < after; ++column) {
      std::uint8_t& pixel = draft_.mask[index(column, y)];
      if (pixel == kUnknown) pixel = kNearOutline;
    }
  }

  std::size_t index(int x, int y) const {
    const PixelRect& rect = draft_.rect;
    return static_cast<std::size_t>(y - rect.y) * static_cast<std::size_t>(rect.width) +
           static_cast<std::size_t>(x - rect.x);
  }
  /// The first row of the draft at or below, or the one after its last; the same of columns.
  int row_from(double y) const {
    return ceil_of(std::clamp(y, double(draft_.rect.y), double(draft_.rect.end_y())));
  }
  int column_from(double x) const {
    return ceil_of(std::clamp(x, double(draft_.rect.x), double(draft_.rect.end_x())));
  }
  /// The column after the last at or before.
  int column_after(double x) const {
    return floor_of(std::clamp(x, draft_.rect.x - 1.0, draft_.rect.end_x() - 1.0)) + 1;
  }

  MaskDraft& draft_;
  double margin_;
  /// By pixel: how much more often the outline winds around it than around its left neighbour.
  std::vector<std::int32_t> turns_;
};

}  // namespace

std::int64_t fill_outline(const RayMesh& mesh, const Eigen::Affine3d& camera_from_object,
                          const PixelCamera& camera, MaskDraft& draft) {
  const auto all_unknown = [&] {
    return std::count(draft.mask.begin(), draft.mask.end(), kUnknown);
  };
  double farthest = 0.0;
  for (const Eigen::Vector3d& corner : mesh.box().corners()) {
    farthest = std::max(farthest, (camera_from_object * corner).norm());
  }
  const double error_m = kRayError * farthest;
  constexpr double kMostStretched = 30.0;
  const double stretched =
      camera_from_object.linear().norm() * camera_from_object.linear().inverse().norm();
  const bool trusted = stretched < kMostStretched && error_m < 0.1 * camera.clip_start_m;
  if (!trusted || mesh.edges().empty()) return all_unknown();
  double margin_px = 0.0;
  const std::vector<Projected> projected =
      project(mesh.tree(), camera_from_object, camera, error_m, margin_px);
  if (projected.empty()) return all_unknown();
  const std::vector<std::uint8_t> clockwise = clockwise_triangles(mesh.tree(), projected);
  Outline outline(draft, margin_px);
  for (const MeshEdge& edge : mesh.edges()) {
    if (clockwise[edge.triangle] == clockwise[edge.opposite]) continue;
    // With the side that runs clockwise on the right.
    const bool along = clockwise[edge.triangle] != 0;
    outline.add(projected[along ? edge.from : edge.to], projected[along ? edge.to : edge.from]);
  }
  return outline.fill();
}

}  // namespace seedframe
