#include "scene/placement.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"

namespace seedframe {

using portable::radians;

Eigen::Matrix3d rotation_and_scale(const Eigen::Vector3d& rotation_deg,
                                   const Eigen::Vector3d& scale) {
  std::array<double, 3> c{};
  std::array<double, 3> s{};
  for (int i = 0; i < 3; ++i) {
    // Multiples of 90° are exact, so that a part laid flat lies flat.
    const double turns = rotation_deg[i] / 90.0;
    if (turns == std::floor(turns)) {
      const int quarter = static_cast<int>(std::fmod(std::fmod(turns, 4.0) + 4.0, 4.0));
      c[static_cast<std::size_t>(i)] =
          std::array{1.0, 0.0, -1.0, 0.0}[static_cast<std::size_t>(quarter)];
      s[static_cast<std::size_t>(i)] =
          std::array{0.0, 1.0, 0.0, -1.0}[static_cast<std::size_t>(quarter)];
    } else {
      c[static_cast<std::size_t>(i)] = portable::cos(radians(rotation_deg[i]));
      s[static_cast<std::size_t>(i)] = portable::sin(radians(rotation_deg[i]));
    }
  }
  Eigen::Matrix3d rx, ry, rz;
  rx << 1, 0, 0, 0, c[0], -s[0], 0, s[0], c[0];
  ry << c[1], 0, s[1], 0, 1, 0, -s[1], 0, c[1];
  rz << c[2], -s[2], 0, s[2], c[2], 0, 0, 0, 1;
  return rz * ry * rx * scale.asDiagonal();
}

Eigen::Matrix3d rotation_of_quaternion(const std::array<double, 4>& wxyz) {
  const double length =
      std::sqrt(wxyz[0] * wxyz[0] + wxyz[1] * wxyz[1] + wxyz[2] * wxyz[2] + wxyz[3] * wxyz[3]);
  const double w = wxyz[0] / length;
  const double x = wxyz[1] / length;
  const double y = wxyz[2] / length;
  const double z = wxyz[3] / length;
  Eigen::Matrix3d rotation;
  rotation << 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),  //
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),          //
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y);
  return rotation;
}

std::array<double, 4> random_quaternion(const std::array<double, 3>& uniform) {
  const double a = std::sqrt(1.0 - uniform[0]);
  const double b = std::sqrt(uniform[0]);
  const double alpha = 2.0 * portable::kPi * uniform[1];
  const double beta = 2.0 * portable::kPi * uniform[2];
  return {b * portable::cos(beta), a * portable::sin(alpha), a * portable::cos(alpha),
          b * portable::sin(beta)};
}

Affine looking_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target, double roll_deg) {
  const Eigen::Vector3d z = (position - target).normalized();
  Eigen::Vector3d x = Eigen::Vector3d::UnitZ().cross(z);
  constexpr double kNearlyVertical = 1e-9;
  x = x.norm() < kNearlyVertical ? Eigen::Vector3d(1, 0, 0) : x.normalized();
  const Eigen::Vector3d y = z.cross(x);
  const double c = portable::cos(radians(roll_deg));
  const double s = portable::sin(radians(roll_deg));
  Affine world_from_view = Affine::Identity();
  world_from_view.linear().col(0) = c * x + s * y;
  world_from_view.linear().col(1) = c * y - s * x;
  world_from_view.linear().col(2) = z;
  world_from_view.translation() = position;
  return world_from_view;
}

Eigen::Vector3d on_shell(const Eigen::Vector3d& target, double distance_m, double azimuth_deg,
                         double elevation_deg) {
  const double azimuth = radians(azimuth_deg);
  const double elevation = radians(elevation_deg);
  const double level = distance_m * portable::cos(elevation);
  return target + Eigen::Vector3d(level * portable::sin(azimuth), -level * portable::cos(azimuth),
                                  distance_m * portable::sin(elevation));
}

Affine resting(const Affine& parent_from_object, double lowest_z, double curvature_per_m) {
  Affine result = parent_from_object;
  if (curvature_per_m == 0.0) {
    result.translation().z() -= lowest_z;
    return result;
  }
  const double x = result.translation().x();
  const double y = result.translation().y();
  const Eigen::Vector3d up(-curvature_per_m * x, -curvature_per_m * y, 1.0);
  const double steepness = std::sqrt(up.x() * up.x() + up.y() * up.y());
  const double length = std::sqrt(steepness * steepness + 1.0);
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Identity();
  if (steepness > 0.0) {
    // About the horizontal axis across the slope; cosine 1/length, sine steepness/length.
    const Eigen::Vector3d axis(-up.y() / steepness, up.x() / steepness, 0.0);
    const double c = 1.0 / length;
    const double s = steepness / length;
    Eigen::Matrix3d cross;
    cross << 0, 0, axis.y(), 0, 0, -axis.x(), -axis.y(), axis.x(), 0;
    tilt += s * cross + (1.0 - c) * cross * cross;
  }
  result.linear() = tilt * result.linear();
  result.translation().z() += 0.5 * curvature_per_m * (x * x + y * y);
  result.translation() -= lowest_z * up / length;
  return result;
}

double footprint_radius(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                        const Eigen::Matrix3d& linear) {
  double radius = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d point((corner & 1) != 0 ? high.x() : low.x(),
                                (corner & 2) != 0 ? high.y() : low.y(),
                                (corner & 4) != 0 ? high.z() : low.z());
    const Eigen::Vector3d mapped = linear * point;
    radius = std::max(radius, std::sqrt(mapped.x() * mapped.x() + mapped.y() * mapped.y()));
  }
  return radius;
}

bool is_clear(const Footprint& circle, const std::vector<Footprint>& others, double gap) {
  return std::all_of(others.begin(), others.end(), [&](const Footprint& other) {
    const double dx = circle.x - other.x;
    const double dy = circle.y - other.y;
    const double least = circle.radius + other.radius + gap;
    return dx * dx + dy * dy >= least * least;
  });
}

Affine relative_to_camera(const Affine& world_from_camera, const Affine& world_from_object) {
  const Eigen::Matrix3d camera_from_world = world_from_camera.linear().transpose();
  Affine result = Affine::Identity();
  result.linear() = camera_from_world * world_from_object.linear();
  result.translation() =
      camera_from_world * (world_from_object.translation() - world_from_camera.translation());
  return result;
}

}  // namespace seedframe
