// Errors of renderings, by hand, and what a noisy reference adds to them.

#include "image/rendering_error.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/philox.h"
#include "image/flip.h"
#include "image/ssim.h"
#include "tests/image/metric_pictures.h"

namespace seedframe {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image<float> rgb_row(const std::vector<float>& values) {
  Image<float> image(static_cast<int>(values.size() / 3), 1, 3);
  image.values = values;
  return image;
}

// Values of tests/image/reference/metrics_reference.py, numpy 1.26.4 and scikit-image 0.24.0.
TEST(LinearError, IsThatOfNumpy) {
  const auto picture = linear_of(noisy_picture(64, 48, 8));
  const LinearError error = linear_error(picture, linear_of(reference_picture(64, 48)));
  EXPECT_EQ(error.pixels, 64 * 48);
  EXPECT_NEAR(error.squared.mse, 0.1083442342, 1e-9);
  EXPECT_NEAR(error.squared.rel_mse, 0.0155679783, 1e-9);
  EXPECT_NEAR(error.squared.mrse, 0.0083992842, 1e-9);
}

TEST(DisplayError, PsnrIsThatOfScikitImage) {
  EXPECT_NEAR(display_error(noisy_picture(64, 48, 8), reference_picture(64, 48)).psnr_db(),
              34.304646115, 1e-8);
}

TEST(LinearError, IsNothingBetweenEqualPictures) {
  const auto picture = linear_of(reference_picture(9, 7));
  const LinearError error = linear_error(picture, picture);
  EXPECT_EQ(error.pixels, 63);
  EXPECT_EQ(error.not_finite, 0);
  EXPECT_EQ(error.squared.mse, 0.0);
  EXPECT_EQ(error.squared.rel_mse, 0.0);
  EXPECT_EQ(error.squared.mrse, 0.0);
  EXPECT_EQ(error.luminance_bias, 0.0);
}

TEST(LinearError, OfOnePixelByHand) {
  const LinearError error =
      linear_error(rgb_row({0.5F, 1.0F, 0.0F}), rgb_row({0.25F, 2.0F, 0.75F}));
  EXPECT_NEAR(error.squared.mse, (0.0625 + 1.0 + 0.5625) / 3.0, 1e-12);
  EXPECT_NEAR(error.squared.rmse(), std::sqrt(1.625 / 3.0), 1e-12);
  EXPECT_NEAR(error.squared.rel_mse,
              (0.0625 / (0.0625 + 0.01) + 1.0 / (4.0 + 0.01) + 0.5625 / (0.5625 + 0.01)) / 3.0,
              1e-12);
  EXPECT_NEAR(error.squared.mrse, 1.625 / (1.01 * 1.01) / 3.0, 1e-12);
  EXPECT_NEAR(error.bias[0], 0.25, 1e-12);
  EXPECT_NEAR(error.bias[1], -1.0, 1e-12);
  EXPECT_NEAR(error.bias[2], -0.75, 1e-12);
  const double expected = 0.2126 * 0.25 + 0.7152 * 2.0 + 0.0722 * 0.75;
  EXPECT_NEAR(error.luminance_bias, (0.2126 * 0.5 + 0.7152) / expected - 1.0, 1e-12);
}

TEST(LinearError, OfAConstantFactorIsItsBias) {
  const auto reference = linear_of(reference_picture(16, 12));
  auto brighter = reference;
  for (float& value : brighter.values) value *= 1.25F;
  const LinearError error = linear_error(brighter, reference);
  EXPECT_NEAR(error.luminance_bias, 0.25, 1e-12);
  EXPECT_GT(error.bias[0], 0.0);
}

TEST(LinearError, BlackReferences) {
  const auto black = rgb_row({0.0F, 0.0F, 0.0F});
  const LinearError error = linear_error(rgb_row({0.1F, 0.1F, 0.1F}), black);
  EXPECT_NEAR(error.squared.rel_mse, 1.0, 1e-6);  // 0.01 / 0.01
  EXPECT_NEAR(error.squared.mrse, 100.0, 1e-4);   // 0.01 / 0.01²
  EXPECT_TRUE(std::isinf(error.luminance_bias));
  EXPECT_EQ(linear_error(black, black).luminance_bias, 0.0);
  // Filters may ring below zero, of all places where 0.01 more is zero.
  const LinearError below = linear_error(black, rgb_row({-0.01F, -0.01F, -0.01F}));
  EXPECT_NEAR(below.squared.mrse, 1.0, 1e-6);
}

TEST(LinearError, PixelsWithNaNOrInfinityAreLeftOutAndCounted) {
  const auto reference = rgb_row({1, 1, 1, 1, 1, 1, 1, kInfinity, 1, 1, 1, 1});
  const LinearError error =
      linear_error(rgb_row({1, kNan, 1, 2, 1, 1, 1, 1, 1, 1, 1, -kInfinity}), reference);
  EXPECT_EQ(error.pixels, 1);
  EXPECT_EQ(error.not_finite, 3);
  EXPECT_NEAR(error.squared.mse, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(error.bias[0], 1.0, 1e-12);
  const LinearError none = linear_error(rgb_row({kNan, 1, 1}), rgb_row({1, 1, 1}));
  EXPECT_EQ(none.pixels, 0);
  EXPECT_EQ(none.squared.mse, 0.0);
}

TEST(LinearError, OfNoPixels) {
  const LinearError error = linear_error(rgb_row({}), rgb_row({}));
  EXPECT_EQ(error.pixels, 0);
  EXPECT_EQ(error.not_finite, 0);
  EXPECT_EQ(error.squared.mrse, 0.0);
}

TEST(LinearError, IgnoresAlphaEvenNaN) {
  const auto picture = linear_of(noisy_picture(8, 6, 9));
  const auto reference = linear_of(reference_picture(8, 6));
  auto rgba = with_alpha(picture);
  rgba.at(2, 2, 3) = kNan;
  const LinearError error = linear_error(rgba, reference);
  EXPECT_EQ(error.pixels, 48);
  EXPECT_EQ(error.squared.mse, linear_error(picture, reference).squared.mse);
}

TEST(DisplayError, OfAConstantOffset) {
  const auto reference = reference_picture(20, 15);
  auto brighter = reference;
  for (auto& value : brighter.values) value = static_cast<std::uint8_t>(value + 3);
  const DisplayError error = display_error(brighter, reference);
  EXPECT_EQ(error.pixels, 300);
  EXPECT_DOUBLE_EQ(error.mse, 9.0);
  EXPECT_DOUBLE_EQ(error.rmse(), 3.0);
  EXPECT_DOUBLE_EQ(error.bias, 3.0);
  EXPECT_NEAR(error.psnr_db(), 20.0 * std::log10(255.0 / 3.0), 1e-9);
  EXPECT_DOUBLE_EQ(display_error(reference, brighter).bias, -3.0);
}

TEST(DisplayError, HasSsimAndFlip) {
  const auto picture = noisy_picture(20, 15, 30);
  const auto reference = reference_picture(20, 15);
  const DisplayError error = display_error(picture, reference);
  EXPECT_EQ(error.ssim, ssim(picture, reference));
  EXPECT_EQ(error.flip, mean_flip(flip_map(picture, reference)));
  EXPECT_GT(error.flip, 0.0);
}

TEST(DisplayError, OfEqualPicturesAndOfNone) {
  const DisplayError same = display_error(reference_picture(12, 12), reference_picture(12, 12));
  EXPECT_EQ(same.rmse(), 0.0);
  EXPECT_TRUE(std::isinf(same.psnr_db()));
  const DisplayError none = display_error(reference_picture(0, 0), reference_picture(0, 0));
  EXPECT_EQ(none.pixels, 0);
  EXPECT_EQ(none.mse, 0.0);
  EXPECT_FALSE(none.ssim.has_value());
}

/// Values of a picture that nobody knows, with even noise of this width around them.
class NoisyRenderings : public testing::Test {
 protected:
  static constexpr int kSide = 128;

  Image<float> rendering(std::uint64_t seed, double width) const {
    const PhiloxStream noise(seed, "noise");
    Image<float> image = truth_;
    for (std::size_t i = 0; i < image.values.size(); ++i) {
      const double u = noise.uniform({.scene = static_cast<std::uint32_t>(i)});
      image.values[i] += static_cast<float>(width * (u - 0.5));
    }
    return image;
  }

  static Image<std::uint8_t> display_of(const Image<float>& linear) {
    Image<std::uint8_t> display(linear.width, linear.height, linear.channels);
    for (std::size_t i = 0; i < linear.values.size(); ++i) {
      const double code =
          std::clamp(64.0 * std::sqrt(std::max(0.0F, linear.values[i])), 0.0, 255.0);
      display.values[i] = static_cast<std::uint8_t>(std::lround(code));
    }
    return display;
  }

  Picture picture(std::uint64_t seed, double width) const {
    Image<float> linear = rendering(seed, width);
    Image<std::uint8_t> display = display_of(linear);
    return {std::move(linear), std::move(display)};
  }

  const Image<float> truth_ = linear_of(reference_picture(kSide, kSide));
};

TEST_F(NoisyRenderings, TheReferencesOwnVarianceIsSubtracted) {
  const Image<float> x = rendering(1, 0.05);
  const Image<float> a = rendering(2, 0.06);
  const Image<float> b = rendering(3, 0.06);
  const SquaredErrors true_errors = linear_error(x, truth_).squared;
  const SquaredErrors measured = linear_error(x, mean_of(a, b)).squared;
  const SquaredErrors variance = linear_variance(a, b);
  EXPECT_NEAR(variance.mse, 0.06 * 0.06 / 12.0 / 2.0, 3e-6);  // of even noise, halved by the mean
  EXPECT_GT(measured.mse, 1.6 * true_errors.mse);
  const SquaredErrors corrected = without_variance(measured, variance);
  EXPECT_NEAR(corrected.mse, true_errors.mse, 0.05 * true_errors.mse);
  EXPECT_NEAR(corrected.rel_mse, true_errors.rel_mse, 0.05 * true_errors.rel_mse);
  EXPECT_NEAR(corrected.mrse, true_errors.mrse, 0.05 * true_errors.mrse);
}

TEST_F(NoisyRenderings, TheCorrectedMseIsTheProductOfBothHalvesDifferences) {
  const Image<float> x = rendering(1, 0.05);
  const Image<float> a = rendering(2, 0.06);
  const Image<float> b = rendering(3, 0.06);
  double product = 0.0;
  for (std::size_t i = 0; i < x.values.size(); ++i) {
    product += (double{x.values[i]} - a.values[i]) * (double{x.values[i]} - b.values[i]);
  }
  EXPECT_NEAR(without_variance(linear_error(x, mean_of(a, b)).squared, linear_variance(a, b)).mse,
              product / static_cast<double>(x.values.size()), 1e-10);
}

TEST_F(NoisyRenderings, ErrorsOfTheDisplayAndOfEdgesAreCorrectedToo) {
  Image<std::uint16_t> ids(kSide, kSide, 1);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      ids.at(row, column) = static_cast<std::uint16_t>((row / 12 + column / 16) % 2);
    }
  }
  const Picture x = picture(1, 0.1);
  const Picture a = picture(2, 0.1);
  const Picture b = picture(3, 0.1);
  const Image<float> mean = mean_of(a.linear, b.linear);
  const Picture truth = {truth_, display_of(truth_)};
  const RenderingError true_error = rendering_error(x, truth, ids);
  const RenderingError measured = rendering_error(x, {mean, display_of(mean)}, ids);
  const RenderingError corrected = without_variance(measured, reference_variance(a, b, ids));
  EXPECT_GT(measured.display.mse, 1.4 * true_error.display.mse);
  EXPECT_NEAR(corrected.display.mse, true_error.display.mse, 0.05 * true_error.display.mse);
  EXPECT_GT(measured.edges.mean_square, 1.4 * true_error.edges.mean_square);
  EXPECT_NEAR(corrected.edges.mean_square, true_error.edges.mean_square,
              0.15 * true_error.edges.mean_square);
  EXPECT_NEAR(corrected.linear.squared.mse, true_error.linear.squared.mse,
              0.05 * true_error.linear.squared.mse);
  EXPECT_EQ(corrected.display.flip, measured.display.flip);
  EXPECT_EQ(corrected.edges.contrast, measured.edges.contrast);
}

TEST(ReferenceVariance, OfEqualHalvesIsNothing) {
  const auto display = reference_picture(6, 5);
  const Picture half = {linear_of(display), display};
  const ReferenceVariance variance = reference_variance(half, half, Image<std::uint16_t>(6, 5));
  EXPECT_EQ(variance.linear.mse, 0.0);
  EXPECT_EQ(variance.display, 0.0);
  EXPECT_EQ(variance.edges, 0.0);
}

TEST(ReferenceVariance, OfOnePixelByHand) {
  const auto a = rgb_row({1.0F, 2.0F, 3.0F});
  const auto b = rgb_row({3.0F, 2.0F, 2.0F});
  EXPECT_NEAR(linear_variance(a, b).mse, (4.0 + 0.0 + 1.0) / 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(linear_variance(a, b).rel_mse, (4.0 / 4.01 + 1.0 / 6.26) / 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(linear_variance(a, b).mrse, 5.0 / std::pow(6.5 / 3.0 + 0.01, 2.0) / 4.0 / 3.0, 1e-12);
  EXPECT_EQ(mean_of(a, b).values, (std::vector<float>{2.0F, 2.0F, 2.5F}));
  EXPECT_EQ(linear_variance(rgb_row({kNan, 0, 0, 1, 1, 1}), rgb_row({0, 0, 0, 1, 1, 3})).mse,
            4.0 / 4.0 / 3.0);
}

TEST(ReferenceVariance, NothingIsLeftBelowZero) {
  EXPECT_EQ(without_variance(0.5, 0.75), 0.0);
  EXPECT_EQ(without_variance(0.75, 0.5), 0.25);
}

}  // namespace
}  // namespace seedframe
