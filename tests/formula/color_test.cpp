#include "formula/color.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

void expect_near(const Rgb& found, const Rgb& expected, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << i;
}

TEST(Color, HsvCornersAreTheirPrimaries) {
  expect_near(linear_from_hsv(0, 1, 1), {1, 0, 0}, 1e-12);
  expect_near(linear_from_hsv(120, 1, 1), {0, 1, 0}, 1e-12);
  expect_near(linear_from_hsv(240, 1, 1), {0, 0, 1}, 1e-12);
  expect_near(linear_from_hsv(60, 1, 1), {1, 1, 0}, 1e-12);
  expect_near(linear_from_hsv(123, 0, 1), {1, 1, 1}, 1e-12);
  expect_near(linear_from_hsv(-120, 1, 1), linear_from_hsv(240, 1, 1), 1e-12);
}

TEST(Color, HsvValuesAreGammaEncoded) {
  expect_near(linear_from_hsv(0, 0, 0.5), {0.21404114, 0.21404114, 0.21404114}, 1e-7);
}

TEST(Color, BlackBodiesHaveLuminanceOne) {
  for (const double kelvin : {1000.0, 1700.0, 2222.0, 3000.0, 4000.0, 6500.0, 12000.0, 40000.0}) {
    const Rgb c = linear_from_kelvin(kelvin);
    EXPECT_NEAR(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2], 1.0, 1e-12);
  }
}

TEST(Color, BlackBodiesGoFromRedToBlue) {
  const Rgb warm = linear_from_kelvin(2800);
  const Rgb cold = linear_from_kelvin(10000);
  EXPECT_GT(warm[0], 2.0 * warm[2]);
  EXPECT_GT(cold[2], cold[0]);
  // D65 white lies close to the locus at 6504 K.
  expect_near(linear_from_kelvin(6504), {1, 1, 1}, 0.06);
}

TEST(Color, PiecesOfTheLocusMeet) {
  for (const double kelvin : {2222.0, 4000.0}) {
    expect_near(linear_from_kelvin(kelvin - 0.01), linear_from_kelvin(kelvin + 0.01), 0.01);
  }
}

}  // namespace
}  // namespace seedframe
