#include "image_files/comparison.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "image/difference.h"

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

// The program compares with difference_of, which also counts pixels and steps, knows of NaN, and
// needs no library.
TEST(ImageComparison, OurOwnFiguresAreThoseOfTheLibrary) {
  std::mt19937 random(7);
  Image<float> a(31, 17, 3);
  Image<float> b(31, 17, 3);
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    a.values[i] = static_cast<float>(random() % 1000) / 500.0f;
    b.values[i] = i % 3 == 0 ? a.values[i] : a.values[i] + static_cast<float>(i % 7) / 100.0f;
  }
  const auto theirs = errors_between(a, b);
  ASSERT_TRUE(theirs) << theirs.error().message;
  const ImageDifference ours = difference_of(a, b, StoredAs::kFloat);
  EXPECT_NEAR(ours.max, theirs->max, 1e-6);
  EXPECT_NEAR(ours.rms, theirs->rms, 1e-9);
  EXPECT_NEAR(ours.psnr_db(1.0), theirs->psnr_db(1.0), 1e-5);
}

}  // namespace
}  // namespace seedframe
