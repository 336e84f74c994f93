#include "preview/environment_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace seedframe {
namespace {

using Eigen::Vector3f;

/// Real spherical harmonics of degree 0 to 2 at a unit vector.
std::array<float, 9> harmonics(const Vector3f& d) {
  const float x = d.x(), y = d.y(), z = d.z();
  return {0.282095F,
          0.488603F * y,
          0.488603F * z,
          0.488603F * x,
          1.092548F * x * y,
          1.092548F * y * z,
          0.315392F * (3.0F * z * z - 1.0F),
          1.092548F * x * z,
          0.546274F * (x * x - y * y)};
}

}  // namespace

AmbientLight AmbientLight::even(const Vector3f& radiance) {
  AmbientLight light;
  light.coefficients_.fill(Vector3f::Zero());
  light.coefficients_[0] = radiance * (2.0F * std::sqrt(std::numbers::pi_v<float>));
  return light;
}

AmbientLight AmbientLight::of_map(const Image<float>& map) {
  constexpr double kPi = std::numbers::pi;
  std::array<Eigen::Vector3d, 9> sums;
  sums.fill(Eigen::Vector3d::Zero());
  for (int row = 0; row < map.height; ++row) {
    const double polar = kPi * (row + 0.5) / map.height;  // from +z
    const double solid_angle =
        2.0 * kPi / map.width *
        (std::cos(kPi * row / map.height) - std::cos(kPi * (row + 1) / map.height));
    for (int column = 0; column < map.width; ++column) {
      const double around = kPi - 2.0 * kPi * (column + 0.5) / map.width;
      const Vector3f direction(static_cast<float>(std::sin(polar) * std::cos(around)),
                               static_cast<float>(std::sin(polar) * std::sin(around)),
                               static_cast<float>(std::cos(polar)));
      const Eigen::Vector3d light =
          solid_angle * Eigen::Map<const Vector3f>(&map.at(row, column)).cast<double>();
      const std::array<float, 9> basis = harmonics(direction);
      for (std::size_t i = 0; i < basis.size(); ++i) sums[i] += double{basis[i]} * light;
    }
  }
  AmbientLight ambient;
  std::transform(sums.begin(), sums.end(), ambient.coefficients_.begin(),
                 [](const Eigen::Vector3d& sum) -> Vector3f { return sum.cast<float>(); });
  return ambient;
}

Vector3f AmbientLight::sum(const std::array<float, 3>& band_weights,
                           const Vector3f& direction) const {
  const std::array<float, 9> basis = harmonics(direction);
  Vector3f light = band_weights[0] * basis[0] * coefficients_[0];
  for (std::size_t i = 1; i < 4; ++i) light += band_weights[1] * basis[i] * coefficients_[i];
  for (std::size_t i = 4; i < 9; ++i) light += band_weights[2] * basis[i] * coefficients_[i];
  return light.cwiseMax(0.0F);
}

Vector3f AmbientLight::irradiance(const Vector3f& normal) const {
  constexpr float kPi = std::numbers::pi_v<float>;
  return sum({kPi, 2.0F / 3.0F * kPi, 0.25F * kPi}, normal);  // equation 8
}

Vector3f AmbientLight::radiance(const Vector3f& direction) const {
  return sum({1.0F, 1.0F, 1.0F}, direction);
}

EnvironmentMap::EnvironmentMap(Image<float> light)
    : map_(std::move(light)), ambient_(AmbientLight::of_map(map_)) {
  assert(map_.width > 0 && map_.height > 0 && map_.channels == 3);
}

Vector3f EnvironmentMap::radiance(const Vector3f& direction) const {
  constexpr float kPi = std::numbers::pi_v<float>;
  const Vector3f unit = direction.normalized();
  const float across = 0.5F - std::atan2(unit.y(), unit.x()) / (2.0F * kPi);
  const float down = std::acos(std::clamp(unit.z(), -1.0F, 1.0F)) / kPi;
  const float x = across * static_cast<float>(map_.width) - 0.5F;
  const float y = std::clamp(down * static_cast<float>(map_.height) - 0.5F, 0.0F,
                             static_cast<float>(map_.height - 1));
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(y);
  const float right_share = x - static_cast<float>(left);
  const float lower_share = y - static_cast<float>(top);
  const auto at = [&](int row, int column) -> Vector3f {
    const int wrapped = ((column % map_.width) + map_.width) % map_.width;
    return Eigen::Map<const Vector3f>(&map_.at(std::min(row, map_.height - 1), wrapped));
  };
  const Vector3f upper = (1.0F - right_share) * at(top, left) + right_share * at(top, left + 1);
  const Vector3f lower =
      (1.0F - right_share) * at(top + 1, left) + right_share * at(top + 1, left + 1);
  return (1.0F - lower_share) * upper + lower_share * lower;
}

}  // namespace seedframe
