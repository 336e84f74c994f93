#include "draws/quantile.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace seedframe::quantile {
namespace {

constexpr int kSteps = 20000;

/// Mean and variance of a quantile function, integrated over evenly spread u.
template <class Quantile>
std::array<double, 2> moments(Quantile q) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = q((i + 0.5) / kSteps);
    sum += x;
    squares += x * x;
  }
  const double mean = sum / kSteps;
  return {mean, squares / kSteps - mean * mean};
}

TEST(Quantile, UniformCoversItsRange) {
  EXPECT_DOUBLE_EQ(uniform(0.25, 2.0, 6.0), 3.0);
  EXPECT_DOUBLE_EQ(uniform(0.5, 3.0, 3.0), 3.0);
}

TEST(Quantile, NormalHasTheTabulatedPercentiles) {
  EXPECT_NEAR(normal(0.5, 1.0, 2.0), 1.0, 1e-15);
  EXPECT_NEAR(normal(0.975, 0.0, 1.0), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normal(1e-10, 0.0, 1.0), -6.361340902404056, 1e-12);
  EXPECT_NEAR(normal(0.3, 5.0, 0.0), 5.0, 0.0);
  const auto [mean, variance] = moments([](double u) { return normal(u, 3.0, 2.0); });
  EXPECT_NEAR(mean, 3.0, 1e-9);
  EXPECT_NEAR(variance, 4.0, 0.01);
}

TEST(Quantile, TruncatedNormalHasTheTextbookMean) {
  // Mean of a standard normal on [0, 1]: (phi(0) - phi(1)) / (Phi(1) - Phi(0)).
  const auto [mean, variance] =
      moments([](double u) { return truncated_normal(u, 0.0, 1.0, 0.0, 1.0); });
  EXPECT_NEAR(mean, 0.4598622292, 1e-6);
  EXPECT_GT(variance, 0.0);
}

TEST(Quantile, TruncatedNormalStaysInsideFarOutInEitherTail) {
  for (const double u : {1e-12, 0.1, 0.5, 0.9, 1.0 - 1e-12}) {
    for (const double low : {-60.0, -30.0, -8.0, 8.0, 30.0, 60.0}) {
      const double x = truncated_normal(u, 0.0, 1.0, low, low + 1.0);
      EXPECT_GE(x, low);
      EXPECT_LE(x, low + 1.0);
    }
  }
  // In a tail nearly all mass sits at the nearer end.
  EXPECT_NEAR(truncated_normal(0.5, 0.0, 1.0, 30.0, 40.0), 30.023, 0.001);
  EXPECT_NEAR(truncated_normal(0.5, 0.0, 1.0, -40.0, -30.0), -30.023, 0.001);
}

TEST(Quantile, LogUniformIsUniformInTheLogarithm) {
  EXPECT_NEAR(log_uniform(0.5, 1.0, 100.0), 10.0, 1e-13);
  EXPECT_DOUBLE_EQ(log_uniform(0.7, 4.0, 4.0), 4.0);
}

TEST(Quantile, IntegersAreAllAsLikely) {
  std::array<int, 6> counts{};
  for (int i = 0; i < kSteps; ++i) {
    ++counts[static_cast<std::size_t>(integer((i + 0.5) / kSteps, 1, 6)) - 1];
  }
  for (const int count : counts) EXPECT_NEAR(count, kSteps / 6.0, 1.0);
  EXPECT_EQ(integer(1.0 - 1e-17, -2, 3), 3);
}

TEST(Quantile, ChoiceFollowsTheWeights) {
  const std::array<double, 4> weights = {0.0, 1.0, 3.0, 0.0};
  std::array<int, 4> counts{};
  for (int i = 0; i < kSteps; ++i) ++counts[choice((i + 0.5) / kSteps, weights)];
  EXPECT_EQ(counts[0], 0);
  EXPECT_EQ(counts[1], kSteps / 4);
  EXPECT_EQ(counts[2], kSteps * 3 / 4);
  EXPECT_EQ(counts[3], 0);
}

TEST(Quantile, EveryQuantileRises) {
  double before_normal = -1e9;
  double before_truncated = -1e9;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps;
    const double n = normal(u, 0, 1);
    const double t = truncated_normal(u, 0, 1, -0.5, 3);
    ASSERT_GT(n, before_normal);
    ASSERT_GT(t, before_truncated);
    before_normal = n;
    before_truncated = t;
  }
}

}  // namespace
}  // namespace seedframe::quantile
