#include "mesh/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace seedframe {
namespace {

Eigen::Vector3d position(const Mesh& mesh, std::uint32_t index) {
  const auto& p = mesh.positions[index];
  return {p[0], p[1], p[2]};
}

template <std::size_t N>
bool all_finite(const std::array<float, N>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](float value) { return std::isfinite(value); });
}

Status check_lengths(const Mesh& mesh, const std::string& what) {
  const std::size_t triangles = mesh.triangles.size();
  if (mesh.positions.empty() || triangles == 0) {
    return fail(ErrorKind::kInput, "{}: the mesh is empty ({} vertices, {} triangles)", what,
                mesh.positions.size(), triangles);
  }
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 3;
  if (mesh.positions.size() > kMost || triangles > kMost) {
    return fail(ErrorKind::kInput, "{}: {} vertices and {} triangles are more than {}", what,
                mesh.positions.size(), triangles, kMost);
  }
  if (mesh.corner_uvs.size() != 3 * triangles) {
    return fail(ErrorKind::kInput, "{}: {} triangles need {} corner UVs, found {}", what, triangles,
                3 * triangles, mesh.corner_uvs.size());
  }
  if (mesh.triangle_slots.size() != triangles) {
    return fail(ErrorKind::kInput, "{}: {} triangles need as many material slots, found {}", what,
                triangles, mesh.triangle_slots.size());
  }
  if (mesh.slot_names.empty()) {
    return fail(ErrorKind::kInput, "{}: a mesh needs at least one material slot", what);
  }
  return {};
}

Status check_values(const Mesh& mesh, const std::string& what) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!all_finite(mesh.positions[i])) {
      return fail(ErrorKind::kInput, "{}: vertex {} has a coordinate that is not finite", what, i);
    }
  }
  for (std::size_t i = 0; i < mesh.corner_uvs.size(); ++i) {
    if (!all_finite(mesh.corner_uvs[i])) {
      return fail(ErrorKind::kInput, "{}: triangle {} has a UV that is not finite", what, i / 3);
    }
  }
  if (!std::isfinite(mesh.smooth_angle_rad) || mesh.smooth_angle_rad < 0.0) {
    return fail(ErrorKind::kInput, "{}: the smoothing angle must be 0 or more radians, found {}",
                what, mesh.smooth_angle_rad);
  }
  return {};
}

Status check_indices(const Mesh& mesh, const std::string& what) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t index : mesh.triangles[i]) {
      if (index >= mesh.positions.size()) {
        return fail(ErrorKind::kInput, "{}: triangle {} names vertex {}, but there are {}", what, i,
                    index, mesh.positions.size());
      }
    }
    if (mesh.triangle_slots[i] >= mesh.slot_names.size()) {
      return fail(ErrorKind::kInput, "{}: triangle {} names material slot {}, but there are {}",
                  what, i, mesh.triangle_slots[i], mesh.slot_names.size());
    }
  }
  return {};
}

// One order of operations for every caller, so that results agree to the last bit.
double mapped_z(const std::array<double, 3>& row, const std::array<float, 3>& p) {
  return row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
}

std::array<double, 3> z_row(const Eigen::Matrix3d& linear) {
  return {linear(2, 0), linear(2, 1), linear(2, 2)};
}

}  // namespace

std::array<Eigen::Vector3d, 8> BoundingBox::corners() const {
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] =
        Eigen::Vector3d((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                        (i & 4) != 0 ? high.z() : low.z());
  }
  return corners;
}

BoundingBox bounding_box(const Mesh& mesh) {
  if (mesh.positions.empty()) return {};
  BoundingBox box{.low = position(mesh, 0), .high = position(mesh, 0)};
  for (std::uint32_t i = 1; i < mesh.positions.size(); ++i) {
    box.low = box.low.cwiseMin(position(mesh, i));
    box.high = box.high.cwiseMax(position(mesh, i));
  }
  return box;
}

double surface_area(const Mesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d origin = position(mesh, a);
    area += 0.5 * (position(mesh, b) - origin).cross(position(mesh, c) - origin).norm();
  }
  return area;
}

Status check_mesh(const Mesh& mesh, const std::string& what) {
  for (const auto check : {check_lengths, check_values, check_indices}) {
    if (Status status = check(mesh, what); !status) return status;
  }
  if (surface_area(mesh) == 0.0) {
    return fail(ErrorKind::kInput, "{}: every triangle has zero area, so nothing could be seen",
                what);
  }
  return {};
}

double lowest_z(const Mesh& mesh, const Eigen::Matrix3d& linear) {
  const auto row = z_row(linear);
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& p : mesh.positions) lowest = std::min(lowest, mapped_z(row, p));
  return lowest;
}

LowestPoint::LowestPoint(const Mesh& mesh) : vertices_(mesh.positions) {
  split(0, vertices_.size());
  for (const auto& vertex : vertices_) {
    lowest_ = &vertex == vertices_.data() ? vertex[2] : std::min(lowest_, vertex[2]);
    highest_ = &vertex == vertices_.data() ? vertex[2] : std::max(highest_, vertex[2]);
  }
}

// Halves the vertices at the median of the box's longest side until a group is small.
void LowestPoint::split(std::size_t first, std::size_t count) {
  if (count == 0) return;
  const auto begin = vertices_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = begin + static_cast<std::ptrdiff_t>(count);
  Group group{.centre = {}, .half_size = {}, .first = first, .count = count};
  std::size_t longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(
        begin, end, [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    group.centre[axis] = 0.5 * (static_cast<double>((*low)[axis]) + (*high)[axis]);
    group.half_size[axis] = 0.5 * (static_cast<double>((*high)[axis]) - (*low)[axis]);
    if (group.half_size[axis] > group.half_size[longest]) longest = axis;
  }
  constexpr std::size_t kGroupSize = 32;
  if (count <= kGroupSize) {
    groups_.push_back(group);
    return;
  }
  const std::size_t half = count / 2;
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half), end,
                   [longest](const auto& a, const auto& b) { return a[longest] < b[longest]; });
  split(first, half);
  split(first + half, count - half);
}

double LowestPoint::z(const Eigen::Matrix3d& linear) const {
  const auto row = z_row(linear);
  if (!vertices_.empty() && row[0] == 0.0 && row[1] == 0.0) {  // upright, as most things stand
    return row[2] * static_cast<double>(row[2] < 0.0 ? highest_ : lowest_);
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const Group& group : groups_) {
    double bound = 0.0;
    double magnitude = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double reach = std::abs(row[axis]) * group.half_size[axis];
      bound += row[axis] * group.centre[axis] - reach;
      magnitude += std::abs(row[axis] * group.centre[axis]) + reach;
    }
    // The bound is rounded too: without this margin a group could be skipped for its last bit.
    bound -= 1e-14 * magnitude;
    if (bound > lowest) continue;
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      lowest = std::min(lowest, mapped_z(row, vertices_[i]));
    }
  }
  return lowest;
}

}  // namespace seedframe
