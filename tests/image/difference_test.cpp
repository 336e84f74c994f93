// How far rasters are from each other, in values and in units in the last place.

#include "image/difference.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

Image<float> row_of(const std::vector<float>& values) {
  Image<float> image(static_cast<int>(values.size()), 1, 1);
  image.values = values;
  return image;
}

TEST(Difference, IsNothingBetweenEqualImages) {
  const auto image = row_of({0.0F, 1.0F, std::numeric_limits<float>::quiet_NaN()});
  const ImageDifference none = difference_of(image, image, StoredAs::kFloat);
  EXPECT_EQ(none.pixels, 3);
  EXPECT_EQ(none.differing, 0);
  EXPECT_EQ(none.max_ulp, 0);
  EXPECT_TRUE(std::isinf(none.psnr_db(1.0)));
}

TEST(Difference, CountsPixelsNotChannels) {
  Image<float> a(2, 1, 3);
  Image<float> b = a;
  b.values = {0.0F, 0.25F, 0.5F, 0.0F, 0.0F, 0.0F};
  const ImageDifference difference = difference_of(a, b, StoredAs::kFloat);
  EXPECT_EQ(difference.differing, 1);
  EXPECT_DOUBLE_EQ(difference.differing_share(), 0.5);
  EXPECT_DOUBLE_EQ(difference.max, 0.5);
  EXPECT_DOUBLE_EQ(difference.rms, std::sqrt((0.0625 + 0.25) / 6.0));
  EXPECT_NEAR(difference.psnr_db(1.0), -10.0 * std::log10((0.0625 + 0.25) / 6.0), 1e-9);
}

TEST(Difference, StepsAreThoseOfTheTypeThatIsStored) {
  const float next_float = std::nextafter(1.0F, 2.0F);
  EXPECT_EQ(difference_of(row_of({1.0F}), row_of({next_float}), StoredAs::kFloat).max_ulp, 1);
  const float next_half = 1.0F + 1.0F / 1024.0F;
  EXPECT_EQ(difference_of(row_of({1.0F}), row_of({next_half}), StoredAs::kHalf).max_ulp, 1);
  EXPECT_EQ(difference_of(row_of({1.0F}), row_of({next_half}), StoredAs::kFloat).max_ulp, 8192);
  // From the least number below zero over both zeros to the least above: they are neighbours.
  const float least = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(difference_of(row_of({-least}), row_of({least}), StoredAs::kFloat).max_ulp, 2);
}

TEST(Difference, NaNIsFarFromEveryNumber) {
  const ImageDifference difference = difference_of(
      row_of({1.0F}), row_of({std::numeric_limits<float>::quiet_NaN()}), StoredAs::kFloat);
  EXPECT_EQ(difference.differing, 1);
  EXPECT_TRUE(std::isinf(difference.max));
}

TEST(Difference, BytesAndIds) {
  Image<std::uint8_t> a(2, 2, 1);
  Image<std::uint8_t> b = a;
  b.values[3] = 7;
  EXPECT_EQ(difference_of(a, b).max_ulp, 7);
  Image<std::uint16_t> x(2, 2);
  Image<std::uint16_t> y = x;
  y.values = {0, 500, 0, 1};
  EXPECT_EQ(difference_of(x, y).differing, 2);
}

TEST(HeatMap, ShowsTheFaintestDifferenceAndTellsItFromALargeOne) {
  Image<float> a(3, 1, 3);
  Image<float> b = a;
  b.at(0, 1, 0) = 1e-7F;
  b.at(0, 2, 0) = 1.0F;
  const Image<std::uint8_t> map = heat_map(a, b);
  EXPECT_EQ(map.at(0, 0, 2), 0) << "equal, and black in the picture";
  EXPECT_EQ(map.at(0, 1, 2), 255) << "blue";
  EXPECT_EQ(map.at(0, 2, 0), 255) << "red";
  EXPECT_LT(map.at(0, 2, 2), 128);
}

}  // namespace
}  // namespace seedframe
