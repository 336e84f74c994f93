#include "image_files/comparison.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(ImageComparison, GivesTheErrorsOfADifferenceThatIsKnown) {
  Image<float> a(4, 2, 3);
  Image<float> b = a;
  b.at(1, 2, 1) = 0.5F;
  b.at(0, 0, 0) = -0.25F;
  const auto errors = errors_between(a, b);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_DOUBLE_EQ(errors->max, 0.5);
  EXPECT_DOUBLE_EQ(errors->mean, 0.75 / 24);
  EXPECT_DOUBLE_EQ(errors->rms, std::sqrt((0.25 + 0.0625) / 24));
  EXPECT_NEAR(errors->psnr_db(1.0), -10 * std::log10(0.3125 / 24), 1e-12);
  EXPECT_NEAR(errors->psnr_db(10.0), errors->psnr_db(1.0) + 20, 1e-12);
}

TEST(ImageComparison, EqualImagesAreInfinitelyClose) {
  const Image<float> a(3, 3, 1);
  const auto errors = errors_between(a, a);
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->max, 0.0);
  EXPECT_EQ(errors->rms, 0.0);
  EXPECT_EQ(errors->psnr_db(1.0), std::numeric_limits<double>::infinity());
}

TEST(ImageComparison, HasAnyNumberOfChannels) {
  for (const int channels : {1, 2, 3, 4, 7}) {
    Image<float> a(5, 5, channels);
    Image<float> b = a;
    b.at(4, 4, channels - 1) = 2.0F;
    const auto errors = errors_between(a, b);
    ASSERT_TRUE(errors);
    EXPECT_DOUBLE_EQ(errors->max, 2.0) << channels;
    EXPECT_DOUBLE_EQ(errors->mean, 2.0 / (25 * channels)) << channels;
  }
}

}  // namespace
}  // namespace seedframe
