// SSIM against scikit-image's, and what its definition says of simple pictures.

#include "image/ssim.h"

#include <gtest/gtest.h>

#include "tests/image/metric_pictures.h"

namespace seedframe {
namespace {

TEST(Ssim, IsThatOfScikitImage) {
  // tests/image/reference/metrics_reference.py, scikit-image 0.24.0.
  EXPECT_NEAR(ssim(noisy_picture(64, 48, 8), reference_picture(64, 48)).value(), 0.944330414, 1e-8);
  EXPECT_NEAR(ssim(noisy_picture(160, 120, 60), reference_picture(160, 120)).value(), 0.508548411,
              1e-8);
  EXPECT_NEAR(ssim(noisy_picture(23, 11, 3), reference_picture(23, 11)).value(), 0.982622096, 1e-8);
}

TEST(Ssim, IsOneOfEqualPicturesAndNeverOfOthers) {
  const auto picture = reference_picture(40, 30);
  EXPECT_DOUBLE_EQ(ssim(picture, picture).value(), 1.0);
  auto other = picture;
  ++other.at(15, 20, 1);
  EXPECT_LT(ssim(other, picture).value(), 1.0 - 1e-9);
}

TEST(Ssim, OfEvenPicturesComparesTheirBrightness) {
  // No variance: (2 x y + C1) / (x² + y² + C1) is left.
  const auto even = [](int code) {
    return picture_by(12, 13, [code](int, int, int) { return code; });
  };
  const double c1 = 2.55 * 2.55;
  EXPECT_NEAR(ssim(even(100), even(120)).value(),
              (2.0 * 100.0 * 120.0 + c1) / (100.0 * 100.0 + 120.0 * 120.0 + c1), 1e-9);
}

TEST(Ssim, IsBelowZeroOfANegative) {
  const auto picture = noisy_picture(32, 32, 60);
  auto negative = picture;
  for (auto& value : negative.values) value = static_cast<std::uint8_t>(255 - value);
  EXPECT_LT(ssim(negative, picture).value(), 0.0);
}

TEST(Ssim, NeedsAWholeWindow) {
  EXPECT_TRUE(ssim(reference_picture(11, 11), reference_picture(11, 11)).has_value());
  EXPECT_FALSE(ssim(reference_picture(10, 40), reference_picture(10, 40)).has_value());
  EXPECT_FALSE(ssim(reference_picture(40, 10), reference_picture(40, 10)).has_value());
  EXPECT_FALSE(ssim(reference_picture(0, 0), reference_picture(0, 0)).has_value());
}

TEST(Ssim, IgnoresAlpha) {
  const auto picture = noisy_picture(20, 16, 9);
  const auto reference = reference_picture(20, 16);
  EXPECT_EQ(ssim(with_alpha(picture), reference), ssim(picture, reference));
}

}  // namespace
}  // namespace seedframe
