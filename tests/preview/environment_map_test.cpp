#include "preview/environment_map.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

using Eigen::Vector3f;
using std::numbers::pi;

/// Of a brightness by the direction from which it comes.
template <class Brightness>
Image<float> map_of(int width, Brightness brightness) {
  Image<float> map(width, width / 2, 3);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double polar = pi * (row + 0.5) / map.height;
      const double around = pi - 2.0 * pi * (column + 0.5) / width;
      const Eigen::Vector3d direction(std::sin(polar) * std::cos(around),
                                      std::sin(polar) * std::sin(around), std::cos(polar));
      for (int c = 0; c < 3; ++c) {
        map.at(row, column, c) = static_cast<float>((c + 1) * brightness(direction));
      }
    }
  }
  return map;
}

TEST(EnvironmentMap, HasItsMiddleAtXItsLeftAtYAndItsTopAtZ) {
  Image<float> map(8, 4, 3);
  map.at(0, 2, 0) = 8.0F;                    // the top
  map.at(1, 4, 0) = map.at(2, 4, 0) = 1.0F;  // right of the middle
  map.at(1, 3, 0) = map.at(2, 3, 0) = 1.0F;  // left of it
  map.at(1, 1, 1) = map.at(2, 1, 1) = 1.0F;  // a quarter from the left
  map.at(1, 2, 1) = map.at(2, 2, 1) = 1.0F;
  const EnvironmentMap environment(map);
  EXPECT_NEAR(environment.radiance({3, 0, 0}).x(), 1.0, 1e-4);
  EXPECT_NEAR(environment.radiance({0, 1, 0}).y(), 1.0, 1e-4);
  EXPECT_NEAR(environment.radiance({0, -1, 0}).norm(), 0.0, 1e-4);
  EXPECT_NEAR(environment.radiance({-1, 0, 0}).norm(), 0.0, 1e-4);
  EXPECT_GT(environment.radiance({0, 0.01F, 1}).x(), 1.0F);
  EXPECT_EQ(environment.radiance({0, 0.01F, -1}).x(), 0.0F);
}

TEST(AmbientLight, OfAnEvenSkyIsPiTimesIt) {
  const AmbientLight of_map = EnvironmentMap(map_of(64, [](const auto&) { return 0.5; })).ambient();
  const AmbientLight even = AmbientLight::even({0.5F, 1.0F, 1.5F});
  for (const Vector3f& normal : {Vector3f(1, 0, 0), Vector3f(0, 0.6F, -0.8F), Vector3f(0, 0, 1)}) {
    EXPECT_TRUE(of_map.irradiance(normal).isApprox(
        Vector3f(0.5F, 1.0F, 1.5F) * static_cast<float>(pi), 2e-3F));
    EXPECT_TRUE(even.irradiance(normal).isApprox(
        Vector3f(0.5F, 1.0F, 1.5F) * static_cast<float>(pi), 1e-4F));
    EXPECT_TRUE(even.radiance(normal).isApprox(Vector3f(0.5F, 1.0F, 1.5F), 1e-4F));
  }
}

TEST(AmbientLight, IsTheIntegralOverTheMap) {
  const Eigen::Vector3d towards = Eigen::Vector3d(0.5, -0.7, 0.6).normalized();
  const auto brightness = [&](const Eigen::Vector3d& direction) {
    return 0.2 + 2.0 * std::pow(std::max(0.0, direction.dot(towards)), 3.0);
  };
  const EnvironmentMap environment(map_of(128, brightness));
  const Image<float> map = map_of(128, brightness);
  for (const Vector3f& normal : {Vector3f(towards.cast<float>()), Vector3f(1, 0, 0),
                                 Vector3f(0, -1, 0), Vector3f(0, 0, 1), Vector3f(0, 0, -1)}) {
    double sum = 0.0;
    for (int row = 0; row < map.height; ++row) {
      const double polar = pi * (row + 0.5) / map.height;
      for (int column = 0; column < map.width; ++column) {
        const double around = pi - 2.0 * pi * (column + 0.5) / map.width;
        const Eigen::Vector3d direction(std::sin(polar) * std::cos(around),
                                        std::sin(polar) * std::sin(around), std::cos(polar));
        sum += map.at(row, column, 1) * std::max(0.0, direction.dot(normal.cast<double>())) *
               std::sin(polar) * pi / map.height * 2.0 * pi / map.width;
      }
    }
    EXPECT_NEAR(environment.ambient().irradiance(normal).y(), sum, 0.03 * 4.0)
        << normal.transpose();
  }
}

TEST(AmbientLight, IsNeverNegative) {
  Image<float> map(64, 32, 3);
  map.at(0, 0, 0) = 1e4F;  // so small a light has a negative lobe on the other side
  const AmbientLight ambient = AmbientLight::of_map(map);
  for (float z = -1.0F; z <= 1.0F; z += 0.1F) {
    const Vector3f normal(std::sqrt(1.0F - z * z), 0, z);
    EXPECT_GE(ambient.irradiance(normal).minCoeff(), 0.0F);
    EXPECT_GE(ambient.radiance(normal).minCoeff(), 0.0F);
  }
}

}  // namespace
}  // namespace seedframe
