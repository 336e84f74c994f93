#include "quality/promise.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Of frames 0, 1, …
std::vector<FrameError> errors_of(const std::vector<double>& values) {
  std::vector<FrameError> errors;
  for (const double value : values) {
    errors.push_back({static_cast<std::int64_t>(errors.size()), value});
  }
  return errors;
}

ErrorPromise promise(double max_error, double share) {
  return {&measure_named("rmse8"), max_error, share};
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
  const std::vector<FrameError> errors = errors_of({1, 2, 3, 4});
  EXPECT_TRUE(check_promise(errors, promise(3.5, 0.75)).is_kept);
  EXPECT_FALSE(check_promise(errors, promise(3.5, 0.8)).is_kept);
  EXPECT_THAT(check_promise(errors, promise(1.5, 0.8)).beyond, ElementsAre(1, 2, 3));
  EXPECT_THAT(check_promise(errors, promise(4.0, 1.0)).beyond, IsEmpty());
}

TEST(Promise, OfNothingIsNotKept) { EXPECT_FALSE(check_promise({}, promise(1.0, 0.5)).is_kept); }

TEST(Promise, IsNotKeptByANumberThatIsNone) {
  const std::vector<FrameError> errors = errors_of({1, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_THAT(check_promise(errors, promise(10.0, 0.95)).beyond, ElementsAre(1));
}

TEST(Promise, OfAPsnrIsTheErrorInCodesThatItMeans) {
  const ErrorPromise psnr = promise_of({QualityMetric::kPsnr, 40.0, 0.9, false});
  EXPECT_STREQ(psnr.measure->key, "rmse8");
  EXPECT_NEAR(psnr.max_error, 2.55, 1e-12);
  EXPECT_EQ(psnr.share, 0.9);
}

TEST(QuantileOfError, IsTheNearestRank) {
  const std::vector<FrameError> errors = errors_of({4, 1, 3, 2});
  EXPECT_DOUBLE_EQ(quantile_of_error(errors, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile_of_error(errors, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(quantile_of_error(errors, 0.51), 3.0);
  EXPECT_DOUBLE_EQ(quantile_of_error(errors, 1.0), 4.0);
  EXPECT_DOUBLE_EQ(quantile_of_error({}, 0.5), 0.0);
}

}  // namespace
}  // namespace seedframe
