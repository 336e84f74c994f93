#include "quality/setting_steps.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(SettingSteps, OfSamplesAreAtMostAHalfApart) {
  EXPECT_EQ(rounded_samples(0.2), 1);
  EXPECT_EQ(rounded_samples(1.0), 1);
  EXPECT_EQ(rounded_samples(1.01), 2);
  EXPECT_EQ(rounded_samples(2.5), 3);
  EXPECT_EQ(rounded_samples(4.5), 6);
  EXPECT_EQ(rounded_samples(100.0), 128);
  for (int step = 1; step < 5000; step = rounded_samples(step + 0.5)) {
    EXPECT_EQ(rounded_samples(step), step);
  }
}

TEST(SettingSteps, OfThresholdsAreQuartersOfAnOctave) {
  EXPECT_DOUBLE_EQ(rounded_threshold(0.4), 0.4);
  EXPECT_DOUBLE_EQ(rounded_threshold(0.39), 0.33636);
  EXPECT_DOUBLE_EQ(rounded_threshold(0.2), 0.2);
  // A threshold that was rounded stays what it is.
  for (const double fine : {0.31, 0.05, 0.011, 0.0012}) {
    const double threshold = rounded_threshold(fine);
    EXPECT_LE(threshold, fine * 1.006);
    EXPECT_DOUBLE_EQ(rounded_threshold(threshold), threshold);
  }
}

}  // namespace
}  // namespace seedframe
