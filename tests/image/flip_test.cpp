// FLIP against its authors' program, and what holds of any picture.

#include "image/flip.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/image/metric_pictures.h"

namespace seedframe {
namespace {

// Values of tests/image/reference/metrics_reference.py, flip-evaluator 1.7.
TEST(Flip, IsThatOfItsAuthors) {
  const Image<float> map = flip_map(noisy_picture(64, 48, 8), reference_picture(64, 48));
  EXPECT_NEAR(mean_flip(map), 0.0532732, 2e-6);
  EXPECT_NEAR(map.at(5, 7), 0.060695, 1e-5);
  EXPECT_NEAR(map.at(0, 0), 0.114875, 1e-5);

  const Image<float> large = flip_map(noisy_picture(160, 120, 60), reference_picture(160, 120));
  EXPECT_NEAR(mean_flip(large), 0.2396284, 2e-6);
  EXPECT_NEAR(large.at(5, 7), 0.183499, 1e-5);
  EXPECT_NEAR(large.at(0, 0), 0.192799, 1e-5);
}

TEST(Flip, OfOtherColorsIsThatOfItsAuthors) {
  EXPECT_NEAR(mean_flip(flip_map(recolored_picture(64, 48), reference_picture(64, 48))), 0.3252056,
              2e-6);
  EXPECT_NEAR(mean_flip(flip_map(recolored_picture(160, 120), reference_picture(160, 120))),
              0.3410680, 2e-6);
}

TEST(Flip, OfAPictureSmallerThanItsFiltersIsThatOfItsAuthors) {
  EXPECT_NEAR(mean_flip(flip_map(noisy_picture(23, 11, 3), reference_picture(23, 11))), 0.0280415,
              2e-6);
}

TEST(Flip, FromAnotherDistanceIsThatOfItsAuthors) {
  EXPECT_NEAR(mean_flip(flip_map(noisy_picture(64, 48, 8), reference_picture(64, 48), 20.0)),
              0.1365970, 2e-6);
  EXPECT_NEAR(mean_flip(flip_map(noisy_picture(160, 120, 60), reference_picture(160, 120), 20.0)),
              0.5269076, 2e-6);
}

TEST(Flip, IsZeroOfEqualPictures) {
  const auto picture = noisy_picture(30, 20, 40);
  const Image<float> map = flip_map(picture, picture);
  EXPECT_TRUE(std::ranges::all_of(map.values, [](float value) { return value == 0.0F; }));
}

TEST(Flip, OfBlackAndWhiteEndsTheRange) {
  const auto even = [](int code) {
    return picture_by(5, 4, [code](int, int, int) { return code; });
  };
  const Image<float> map = flip_map(even(255), even(0));
  for (const float value : map.values) {
    EXPECT_GT(value, 0.9F);
    EXPECT_LE(value, 1.0F);
  }
}

TEST(Flip, PicturesMayChangePlaces) {
  const auto a = noisy_picture(30, 20, 40);
  const auto b = reference_picture(30, 20);
  EXPECT_EQ(flip_map(a, b).values, flip_map(b, a).values);
}

TEST(Flip, OnePixelIsSeenAroundItAndNowhereElse) {
  const auto reference = picture_by(64, 64, [](int, int, int) { return 60; });
  auto picture = reference;
  picture.at(32, 32, 0) = picture.at(32, 32, 1) = picture.at(32, 32, 2) = 255;
  const Image<float> map = flip_map(picture, reference);
  EXPECT_GT(map.at(32, 32), 0.1F);
  EXPECT_GT(map.at(32, 32), map.at(32, 36));
  EXPECT_EQ(map.at(32, 50), 0.0F);
  EXPECT_EQ(map.at(10, 32), 0.0F);
}

TEST(Flip, OfNoPixelsAndOfOne) {
  EXPECT_EQ(mean_flip(flip_map(reference_picture(0, 0), reference_picture(0, 0))), 0.0);
  const auto white = picture_by(1, 1, [](int, int, int) { return 255; });
  const auto black = picture_by(1, 1, [](int, int, int) { return 0; });
  EXPECT_GT(mean_flip(flip_map(white, black)), 0.9);
}

TEST(Flip, IgnoresAlpha) {
  const auto picture = noisy_picture(20, 16, 9);
  const auto reference = reference_picture(20, 16);
  EXPECT_EQ(flip_map(picture, with_alpha(reference)).values, flip_map(picture, reference).values);
}

}  // namespace
}  // namespace seedframe
