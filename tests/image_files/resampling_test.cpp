#include "image_files/resampling.h"

#include <cmath>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

Image<std::uint8_t> filled(int width, int height, std::uint8_t value) {
  Image<std::uint8_t> image(width, height, 3);
  std::fill(image.values.begin(), image.values.end(), value);
  return image;
}

TEST(Resampling, AFlatImageStaysFlatAtAnySize) {
  for (const int value : {0, 1, 10, 11, 128, 254, 255}) {
    const Image<std::uint8_t> flat = filled(40, 30, static_cast<std::uint8_t>(value));
    for (const auto& [width, height] : {std::pair(7, 5), {90, 100}, {40, 3}, {1, 1}, {13, 77}}) {
      const auto out = resampled(flat, width, height);
      ASSERT_TRUE(out) << out.error().message;
      EXPECT_EQ(out->values, filled(width, height, static_cast<std::uint8_t>(value)).values)
          << value << ' ' << width << ' ' << height;
    }
  }
}

TEST(Resampling, LightIsAveragedNotItsEncoding) {
  Image<std::uint8_t> stripes = filled(64, 64, 0);
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; column += 2) {
      for (int c = 0; c < 3; ++c) stripes.at(row, column, c) = 255;
    }
  }
  const auto out = resampled(stripes, 16, 16);
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->at(8, 8), 188, 2);  // half the light in sRGB, where half the number is 128
}

TEST(Resampling, ASmallerPixelIsTheMeanOfTheAreaThatItCovers) {
  // Five pixels to two: the first covers two and a half of them.
  Image<std::uint8_t> five = filled(5, 1, 0);
  const auto light_of = [](double light) {
    return static_cast<int>(std::lround(255 * (1.055 * std::pow(light, 1 / 2.4) - 0.055)));
  };
  for (int lit = 0; lit < 5; ++lit) {
    five = filled(5, 1, 0);
    for (int c = 0; c < 3; ++c) five.at(0, lit, c) = 255;
    const auto out = resampled(five, 2, 1);
    ASSERT_TRUE(out);
    const double left = lit < 2 ? 1 / 2.5 : lit == 2 ? 0.5 / 2.5 : 0.0;
    const double right = lit > 2 ? 1 / 2.5 : lit == 2 ? 0.5 / 2.5 : 0.0;
    EXPECT_EQ(out->at(0, 0), left > 0 ? light_of(left) : 0) << lit;
    EXPECT_EQ(out->at(0, 1), right > 0 ? light_of(right) : 0) << lit;
  }
}

TEST(Resampling, NothingRingsBesideAnEdge) {
  Image<std::uint8_t> edge = filled(100, 60, 60);
  for (int row = 0; row < 60; ++row) {
    for (int column = 43; column < 100; ++column) {
      for (int c = 0; c < 3; ++c) edge.at(row, column, c) = 180;
    }
  }
  const auto out = resampled(edge, 32, 32);
  ASSERT_TRUE(out);
  for (const std::uint8_t value : out->values) {
    EXPECT_GE(value, 60);
    EXPECT_LE(value, 180);
  }
}

TEST(Resampling, ADirectionThatKeepsItsSizeIsLeftAlone) {
  Image<std::uint8_t> rows = filled(30, 6, 0);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 30; ++column) {
      for (int c = 0; c < 3; ++c)
        rows.at(row, column, c) = static_cast<std::uint8_t>(row % 2 * 255);
    }
  }
  const auto out = resampled(rows, 10, 6);
  ASSERT_TRUE(out);
  for (int row = 0; row < 6; ++row) EXPECT_EQ(out->at(row, 5), row % 2 * 255);
}

TEST(Resampling, PositionsKeepTheirPlace) {
  Image<std::uint8_t> half = filled(32, 32, 0);
  for (int row = 0; row < 32; ++row) {
    for (int column = 16; column < 32; ++column) half.at(row, column, 1) = 255;
  }
  for (const int size : {8, 16, 32, 64, 128}) {
    const auto out = resampled(half, size, size);
    ASSERT_TRUE(out);
    EXPECT_EQ(out->at(size / 2, size / 4, 1), 0) << size;
    EXPECT_EQ(out->at(size / 2, 3 * size / 4, 1), 255) << size;
    EXPECT_EQ(out->at(size / 2, 3 * size / 4, 0), 0) << size;
  }
}

TEST(Resampling, TheSameSizeIsTheSameImage) {
  Image<std::uint8_t> image = filled(5, 4, 9);
  image.at(2, 3, 1) = 200;
  EXPECT_EQ(resampled(image, 5, 4)->values, image.values);
}

}  // namespace
}  // namespace seedframe
