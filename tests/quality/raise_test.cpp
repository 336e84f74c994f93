#include "quality/raise.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "quality/setting_steps.h"

namespace seedframe {
namespace {

constexpr ErrorBound kBound = {QualityMetric::kRmse8, 4.0};
constexpr int kMost = 512;

RenderChoice plain(int samples) { return {samples, {}, Denoise::kOff}; }
RenderChoice with_denoiser(int samples) { return {samples, {}, Denoise::kOidnFast}; }
RenderChoice adaptive(double threshold) { return {kMost, {threshold, 16}, Denoise::kOff}; }

TEST(RaisedChoice, OfPlainSamplesFollowsTheRootOfTheirNumber) {
  // Twice the error, with a tenth for safety: 2.2² as many samples.
  EXPECT_EQ(raised_choice(plain(16), 8.0, kBound, kMost), plain(96));
  EXPECT_EQ(raised_choice(plain(16), 4.01, kBound, kMost), plain(24)) << "at least the next step";
  EXPECT_EQ(raised_choice(plain(1), 4.01, kBound, kMost), plain(2));
}

TEST(RaisedChoice, OfRelMseFollowsTheirNumberItself) {
  EXPECT_EQ(raised_choice(plain(16), 0.02, {QualityMetric::kRelMse, 0.01}, kMost), plain(48));
}

TEST(RaisedChoice, OfDenoisedFramesNeedsMoreOfThem) {
  EXPECT_EQ(raised_choice(with_denoiser(4), 6.0, kBound, kMost), with_denoiser(32));
  EXPECT_EQ(raised_choice(with_denoiser(16), 12.0, kBound, kMost), plain(kMost))
      << "beyond that a denoiser is not worth its bias";
}

TEST(RaisedChoice, OfAdaptiveSamplingIsAFinerThresholdAndALaterFirstLook) {
  const auto raised = raised_choice(adaptive(0.1), 5.0, kBound, kMost);
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->samples, kMost);
  EXPECT_EQ(raised->adaptive.min_samples, 48)
      << "looks at 64 instead of 32, 1.375² as many or more";
  EXPECT_LT(raised->adaptive.threshold, 0.1 / 2.0);
  EXPECT_GT(raised->adaptive.threshold, 0.1 / 4.0);
  EXPECT_EQ(raised->adaptive.threshold, rounded_threshold(raised->adaptive.threshold));
  EXPECT_LT(raised_choice(adaptive(0.1), 4.01, kBound, kMost)->adaptive.threshold, 0.1);
  EXPECT_EQ(raised_choice(adaptive(0.002), 8.0, kBound, kMost), plain(kMost));
  EXPECT_EQ(raised_choice(adaptive(0.4), 16.0, kBound, kMost), plain(kMost))
      << "its first look would be later than all samples";
}

TEST(RaisedChoice, NeverHasMoreThanTheMostSamples) {
  EXPECT_EQ(raised_choice(plain(384), 4.5, kBound, kMost), plain(kMost));
  EXPECT_EQ(raised_choice(plain(64), 400.0, kBound, 100), plain(100));
  EXPECT_EQ(raised_choice(plain(kMost), 4.5, kBound, kMost), std::nullopt);
  EXPECT_EQ(raised_choice(plain(16), std::numeric_limits<double>::quiet_NaN(), kBound, kMost),
            plain(kMost));
}

}  // namespace
}  // namespace seedframe
