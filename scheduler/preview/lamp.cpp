#include "preview/lamp.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace seedframe {
namespace {

using Eigen::Vector3d;

std::array<double, 2> half_size_of(const LightSpec& light) {
  switch (light.kind) {
    case LightKind::kPoint:
    case LightKind::kSpot:
      return {light.radius_m, light.radius_m};
    case LightKind::kSun: {
      const double radius = std::tan(0.5 * std::min(light.angle_rad, 3.0));
      return {radius, radius};
    }
    case LightKind::kArea:
      return {0.5 * light.width_m, 0.5 * light.height_m};
  }
  return {};
}

}  // namespace

const std::array<std::array<double, 2>, kLampPlaces>& disc_points() {
  static const auto points = [] {
    constexpr double kGoldenAngle = 2.399963229728653;
    std::array<std::array<double, 2>, kLampPlaces> made{};
    for (std::size_t i = 0; i < made.size(); ++i) {
      const double angle = kGoldenAngle * static_cast<double>(i);
      const double radius = std::sqrt((static_cast<double>(i) + 0.5) / kLampPlaces);
      made[i] = {radius * std::cos(angle), radius * std::sin(angle)};
    }
    return made;
  }();
  return points;
}

Lamp::Lamp(const LightSpec& light)
    : kind_(light.kind),
      place_(light.camera_from_light.translation()),
      axes_(light.camera_from_light.linear().colwise().normalized()),
      power_(light.power * Vector3d(light.color[0], light.color[1], light.color[2])),
      cone_edge_(std::cos(0.5 * light.angle_rad)),
      cone_blend_(light.blend * (1.0 - cone_edge_)),
      half_size_(half_size_of(light)) {}

bool Lamp::has_size() const { return half_size_[0] > 0.0 || half_size_[1] > 0.0; }

double Lamp::irradiance(const Vector3d& point, const Vector3d& normal) const {
  const Vector3d back = axes_.col(2);
  if (kind_ == LightKind::kSun) return std::max(0.0, normal.dot(back));
  const Vector3d to_lamp = place_ - point;
  const double distance2 = std::max(to_lamp.squaredNorm(), 1e-9);
  const Vector3d direction = to_lamp / std::sqrt(distance2);
  const double facing = std::max(0.0, normal.dot(direction));
  const double leaving = direction.dot(back);  // cosine at the lamp
  double aimed = 1.0;
  if (kind_ == LightKind::kArea) aimed = 4.0 * std::max(0.0, leaving);
  if (kind_ == LightKind::kSpot) {
    const double inside = leaving - cone_edge_;
    const double share =
        cone_blend_ > 0.0 ? std::clamp(inside / cone_blend_, 0.0, 1.0) : (inside > 0.0 ? 1.0 : 0.0);
    aimed = share * share * (3.0 - 2.0 * share);
  }
  return facing * aimed / (4.0 * std::numbers::pi * distance2);
}

LightRay Lamp::ray_from(const Vector3d& point, std::size_t place) const {
  if (kind_ == LightKind::kArea) {
    constexpr std::size_t kSide = 4;
    constexpr std::array<std::uint8_t, kLampPlaces> kCells = {0, 15, 3, 12, 5,  10, 6, 9,
                                                              1, 14, 7, 8,  13, 2,  4, 11};
    const std::size_t column = kCells[place] % kSide, row = kCells[place] / kSide;
    const double x = (static_cast<double>(column) + 0.5) / (0.5 * kSide) - 1.0;
    const double y = (static_cast<double>(row) + 0.5) / (0.5 * kSide) - 1.0;
    const Vector3d to =
        place_ + half_size_[0] * x * axes_.col(0) + half_size_[1] * y * axes_.col(1) - point;
    const double length = to.norm();
    return {point, to / length, length};
  }
  // A ball or a sun is a disc that faces the surface.
  const bool is_sun = kind_ == LightKind::kSun;
  const Vector3d to_middle = is_sun ? Vector3d(axes_.col(2)) : Vector3d(place_ - point);
  const auto [x, y] = disc_points()[kLampPlaces - 1 - place];
  const Vector3d across = to_middle.unitOrthogonal();
  const Vector3d to =
      to_middle + half_size_[0] * (x * across + y * to_middle.normalized().cross(across));
  const double length = to.norm();
  LightRay ray{point, to / length};
  if (!is_sun) ray.length_m = length;
  return ray;
}

}  // namespace seedframe
