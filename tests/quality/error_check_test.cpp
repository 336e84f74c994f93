#include "quality/error_check.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Frames 0, 1, … with these errors in rmse8.
ErrorCheck check_with(const std::vector<double>& errors) {
  ErrorCheck check;
  for (const double error : errors) {
    CheckedFrame frame;
    frame.frame = static_cast<std::int64_t>(check.frames.size());
    frame.error.display.mse = error * error;
    check.frames.push_back(frame);
  }
  return check;
}

ErrorPromise promise_of(double max_error, double share) {
  return {&measure_named("rmse8"), max_error, share};
}

std::vector<std::int64_t> frames_up_to(std::int64_t count) {
  std::vector<std::int64_t> frames;
  for (std::int64_t i = 0; i < count; ++i) frames.push_back(10 * i);
  return frames;
}

TEST(StratifiedSample, HasOneFrameOfEachPart) {
  const std::vector<std::int64_t> done = frames_up_to(100);
  const std::vector<std::int64_t> sample = stratified_sample(done, 7, 3);
  ASSERT_EQ(sample.size(), 7u);
  for (std::int64_t i = 0; i < 7; ++i) {
    EXPECT_GE(sample[static_cast<std::size_t>(i)], 10 * (i * 100 / 7));
    EXPECT_LT(sample[static_cast<std::size_t>(i)], 10 * ((i + 1) * 100 / 7));
  }
  EXPECT_EQ(stratified_sample(done, 7, 3), sample);
  EXPECT_NE(stratified_sample(done, 7, 4), sample);
}

TEST(StratifiedSample, IsAllWhenMoreAreAskedFor) {
  EXPECT_THAT(stratified_sample({3, 5}, 2, 0), ElementsAre(3, 5));
  EXPECT_THAT(stratified_sample({3, 5}, 9, 0), ElementsAre(3, 5));
  EXPECT_THAT(stratified_sample({}, 9, 0), IsEmpty());
}

// From the formula, computed apart in Python.
TEST(EstimatedShare, HasWilsonsInterval) {
  const EstimatedShare all = estimate_share(12, 12);
  EXPECT_DOUBLE_EQ(all.value, 1.0);
  EXPECT_NEAR(all.least, 0.757506, 1e-6);
  EXPECT_NEAR(all.most, 1.0, 1e-12);
  const EstimatedShare most = estimate_share(18, 20);
  EXPECT_NEAR(most.least, 0.698966, 1e-6);
  EXPECT_NEAR(most.most, 0.972134, 1e-6);
  const EstimatedShare none = estimate_share(0, 0);
  EXPECT_EQ(none.least, 0.0);
  EXPECT_EQ(none.most, 1.0);
}

TEST(Promise, IsKeptIfTheShareIsReached) {
  const ErrorCheck check = check_with({1, 2, 3, 4});
  EXPECT_TRUE(check_promise(check, promise_of(3.5, 0.75)).is_kept);
  EXPECT_FALSE(check_promise(check, promise_of(3.5, 0.8)).is_kept);
  EXPECT_THAT(check_promise(check, promise_of(1.5, 0.8)).beyond, ElementsAre(1, 2, 3));
  EXPECT_THAT(check_promise(check, promise_of(4.0, 1.0)).beyond, IsEmpty());
}

TEST(Promise, OfNothingIsNotKept) {
  EXPECT_FALSE(check_promise(ErrorCheck(), promise_of(1.0, 0.5)).is_kept);
}

TEST(Promise, IsNotKeptByANumberThatIsNone) {
  const ErrorCheck check = check_with({1, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_THAT(check_promise(check, promise_of(10.0, 0.95)).beyond, ElementsAre(1));
}

TEST(QuantileOfError, IsTheNearestRank) {
  const ErrorCheck check = check_with({4, 1, 3, 2});
  const Measure& codes = measure_named("rmse8");
  EXPECT_DOUBLE_EQ(quantile_of_error(check, codes, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile_of_error(check, codes, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(quantile_of_error(check, codes, 0.51), 3.0);
  EXPECT_DOUBLE_EQ(quantile_of_error(check, codes, 1.0), 4.0);
  EXPECT_DOUBLE_EQ(quantile_of_error(ErrorCheck(), codes, 0.5), 0.0);
}

}  // namespace
}  // namespace seedframe
