// The judges are judged first: against tables, and by samples that they must refuse.

#include "tests/scene/statistics.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

double unit_cdf(double x) { return std::clamp(x, 0.0, 1.0); }

std::vector<double> grid(std::size_t count) {
  std::vector<double> samples;
  for (std::size_t i = 0; i < count; ++i) {
    samples.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(count));
  }
  return samples;
}

TEST(Statistics, KolmogorovHasTheTabulatedValues) {
  // Critical values of √n·D for large n: 1.2238 at 0.10, 1.3581 at 0.05, 1.6276 at 0.01.
  constexpr std::size_t kMany = 100'000'000;
  EXPECT_NEAR(kolmogorov_p(1.2238e-4, kMany), 0.10, 1e-4);
  EXPECT_NEAR(kolmogorov_p(1.3581e-4, kMany), 0.05, 1e-4);
  EXPECT_NEAR(kolmogorov_p(1.6276e-4, kMany), 0.01, 1e-4);
  // For n = 100 the exact critical value at 0.05 is 0.13403.
  EXPECT_NEAR(kolmogorov_p(0.13403, 100), 0.05, 1e-3);
}

TEST(Statistics, KolmogorovMeasuresTheLargestDistance) {
  EXPECT_NEAR(kolmogorov_distance(grid(100), unit_cdf), 0.005, 1e-12);
  EXPECT_NEAR(kolmogorov_distance({0.9, 0.1}, unit_cdf), 0.4, 1e-12);
}

TEST(Statistics, KolmogorovRefusesAShiftOfOneHundredth) {
  std::vector<double> samples = grid(100'000);
  EXPECT_GT(kolmogorov_p(samples, unit_cdf), 0.99);
  for (double& x : samples) x = 0.99 * x + 0.01;
  EXPECT_LT(kolmogorov_p(samples, unit_cdf), kLeastP);
}

TEST(Statistics, ChiSquaredHasTheTabulatedValues) {
  // With 3 degrees of freedom 7.815 is exceeded with probability 0.05.
  const double off = std::sqrt(7.815 * 100.0 / 4.0);
  EXPECT_NEAR(chi_squared_p({100 + off, 100 - off, 100 + off, 100 - off}, {100, 100, 100, 100}),
              0.05, 1e-4);
  EXPECT_DOUBLE_EQ(chi_squared_p({10, 20}, {10, 20}), 1.0);
}

TEST(Statistics, CorrelationTellsDependentFromIndependent) {
  EXPECT_NEAR(correlation({1, 2, 3}, {2, 4, 6}), 1.0, 1e-12);
  EXPECT_NEAR(correlation({1, 2, 3}, {3, 2, 1}), -1.0, 1e-12);
  // r = 0.196 of 100 pairs is at the edge of what chance does one time in twenty.
  EXPECT_NEAR(correlation({1, -1, 1, -1}, {1, 1, -1, -1}), 0.0, 1e-12);
  const std::vector<double> x = grid(1000);
  std::vector<double> y = grid(1000);
  std::rotate(y.begin(), y.begin() + 100, y.end());
  EXPECT_LT(independence_p(x, y), kLeastP);
}

}  // namespace
}  // namespace seedframe
