#include "quality/sample_counts.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

/// The pass of pixels that had these samples.
Image<float> shares_of(const std::vector<int>& samples) {
  Image<float> shares(static_cast<int>(samples.size()), 1, 1);
  const auto most = static_cast<float>(*std::max_element(samples.begin(), samples.end()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    shares.values[i] = static_cast<float>(samples[i]) / most;
  }
  return shares;
}

TEST(MeanSamples, AreOfAllPixels) {
  EXPECT_NEAR(mean_samples(shares_of({32, 32, 48, 256}), 256), 92.0, 1e-3);
  EXPECT_NEAR(mean_samples(shares_of({32, 64, 96, 208}), 1024), 100.0, 1e-3);
  EXPECT_NEAR(mean_samples(shares_of({48, 80, 1008, 1024}), 1024), 540.0, 1e-3);
}

TEST(MeanSamples, WherePixelsAreAlikeAreTheFirstLook) {
  EXPECT_DOUBLE_EQ(mean_samples(shares_of({256, 256}), 1024), 32.0);
}

TEST(MeanSamples, MayEndBetweenTwoLooks) {
  EXPECT_NEAR(mean_samples(shares_of({32, 48, 64, 100}), 100), 61.0, 1e-3);
  EXPECT_DOUBLE_EQ(mean_samples(shares_of({20, 20}), 20), 20.0);
}

}  // namespace
}  // namespace seedframe
