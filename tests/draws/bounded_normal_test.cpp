#include "draws/bounded_normal.h"

#include <cmath>
#include <vector>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"
#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

struct MeanAndStd {
  double mean = 0.0;
  double std = 0.0;
};

/// Of what is between min and max, from the distribution function alone: E[X] = min + ∫ (1 - F),
/// and E[(X - min)^2] = 2 ∫ (x - min) (1 - F).
MeanAndStd integrated(const BoundedNormal& normal, double min, double max) {
  using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;
  constexpr unsigned kDeepest = 12;
  constexpr double kTolerance = 1e-11;
  const double first = Rule::integrate([&](double x) { return 1.0 - normal.share_up_to(x); }, min,
                                       max, kDeepest, kTolerance);
  const double second =
      Rule::integrate([&](double x) { return 2.0 * (x - min) * (1.0 - normal.share_up_to(x)); },
                      min, max, kDeepest, kTolerance);
  return {min + first, std::sqrt(second - first * first)};
}

void expect_moments(double mean, double std, double min, double max) {
  SCOPED_TRACE(fmt::format("mean {}, std {} on [{}, {}]", mean, std, min, max));
  ASSERT_EQ(BoundedNormal::error(mean, std, min, max), "");
  const MeanAndStd found = integrated(BoundedNormal(mean, std, min, max), min, max);
  EXPECT_NEAR(found.mean, mean, 1e-8 * std);
  EXPECT_NEAR(found.std, std, 1e-6 * std);
}

double standard_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }
double standard_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI); }

TEST(BoundedNormal, HasTheMomentsThatAreAskedForOverTheRangesOfTheStudy) {
  // The parameters of configs/parts_study.yaml; those of the shares have the range 0 to 1.
  for (const auto& [min, max] : std::vector<std::pair<double, double>>{
           {0, 1}, {0, 2}, {1, 20}, {0.1, 5}, {0.2, 3}, {1, 400}}) {
    for (const double at : {0.03, 0.2, 0.5, 0.785, 0.965}) {
      const double mean = min + at * (max - min);
      const double limit = BoundedNormal::std_limit(mean, min, max);
      for (const double share : {0.1, 0.5, 0.9, 0.999}) {
        expect_moments(mean, share * limit, min, max);
      }
    }
  }
}

TEST(BoundedNormal, IsThePieceOfTheNormalDistributionThatHasThem) {
  // The textbook's mean and variance of N(0.3, 0.4) given [0, 1].
  const double low = (0.0 - 0.3) / 0.4;
  const double high = (1.0 - 0.3) / 0.4;
  const double inside = standard_cdf(high) - standard_cdf(low);
  const double shift = (standard_density(low) - standard_density(high)) / inside;
  const double mean = 0.3 + 0.4 * shift;
  const double variance =
      0.16 * (1.0 + (low * standard_density(low) - high * standard_density(high)) / inside -
              shift * shift);
  const BoundedNormal normal(mean, std::sqrt(variance), 0.0, 1.0);
  for (const double x : {0.01, 0.2, 0.5, 0.8, 0.99}) {
    EXPECT_NEAR(normal.share_up_to(x), (standard_cdf((x - 0.3) / 0.4) - standard_cdf(low)) / inside,
                1e-12);
  }
  EXPECT_EQ(normal.share_up_to(-0.1), 0.0);
  EXPECT_EQ(normal.share_up_to(1.0), 1.0);
}

TEST(BoundedNormal, IsTheNormalDistributionItselfFarFromTheEnds) {
  const BoundedNormal normal(5.0, 0.1, -1e300, 1e300);
  EXPECT_NEAR(normal.quantile(0.975), 5.0 + 0.1 * 1.959963984540054, 1e-14);
  EXPECT_NEAR(normal.quantile(1e-10), 5.0 - 0.1 * 6.361340902404056, 1e-12);
  EXPECT_NEAR(normal.quantile(0.5), 5.0, 1e-15);
}

TEST(BoundedNormal, ComesNearTheUniformAndTheExponentialDistribution) {
  const BoundedNormal uniform(0.5, 0.288675134, 0.0, 1.0);  // below 1 / sqrt(12) by 6e-10
  const BoundedNormal exponential(0.1, 0.1 * (1.0 - 1e-8), 0.0, 1e9);
  for (const double u : {1e-12, 0.2, 0.5, 0.9, 1.0 - 1e-12}) {
    EXPECT_NEAR(uniform.quantile(u), u, 1e-7);
    EXPECT_NEAR(exponential.quantile(u), -0.1 * std::log1p(-u), 1e-5);
  }
}

TEST(BoundedNormal, QuantilesRiseFromEndToEndAndAreTheInverseOfTheShares) {
  for (const auto& [mean, std] :
       std::vector<std::pair<double, double>>{{0.965, 0.0349}, {0.5, 0.1}, {1e-6, 9e-7}}) {
    const BoundedNormal normal(mean, std, 0.0, 1.0);
    double before = 0.0;
    for (const double u :
         {1e-16, 1e-9, 1e-3, 0.1, 0.4999, 0.5, 0.5001, 0.9, 1.0 - 1e-9, 1.0 - 1e-16}) {
      const double x = normal.quantile(u);
      EXPECT_GE(x, before);
      EXPECT_LE(x, 1.0);
      EXPECT_NEAR(normal.share_up_to(x), u, 1e-13);
      before = x;
    }
  }
}

TEST(BoundedNormal, IsMirroredAndScaledWithItsRange) {
  const BoundedNormal normal(0.2, 0.15, 0.0, 1.0);
  const BoundedNormal mirrored(0.8, 0.15, 0.0, 1.0);
  const BoundedNormal scaled(-800.0, 150.0, -1000.0, 0.0);
  for (const double u : {1e-6, 0.3, 0.7, 0.999}) {
    EXPECT_NEAR(mirrored.quantile(1.0 - u), 1.0 - normal.quantile(u), 1e-10);
    EXPECT_NEAR(scaled.quantile(u), 1000.0 * normal.quantile(u) - 1000.0, 1e-9);
  }
}

TEST(BoundedNormal, WithoutDeviationIsItsMean) {
  EXPECT_EQ(BoundedNormal(0.965, 0.0, 0.0, 1.0).quantile(0.3), 0.965);
  EXPECT_EQ(BoundedNormal(2.0, 0.0, 2.0, 2.0).quantile(0.9), 2.0);
  EXPECT_EQ(BoundedNormal(1.0, 0.0, 0.0, 1.0).share_up_to(0.999), 0.0);
  EXPECT_EQ(BoundedNormal(1.0, 0.0, 0.0, 1.0).share_up_to(1.0), 1.0);
}

TEST(BoundedNormal, StaysFiniteWithExtremeNumbers) {
  for (const auto& [mean, std, min, max] :
       std::vector<std::array<double, 4>>{{0, 1e307, -1e308, 1e308},
                                          {0.5, 1e-300, 0, 1},
                                          {5e-324, 4e-324, 0, 1e308},
                                          {1, 1e-17, 0, 2}}) {
    if (!BoundedNormal::error(mean, std, min, max).empty()) continue;
    const BoundedNormal normal(mean, std, min, max);
    for (const double u : {1e-16, 0.5, 1.0 - 1e-16}) {
      EXPECT_TRUE(std::isfinite(normal.quantile(u)));
      EXPECT_GE(normal.quantile(u), min);
      EXPECT_LE(normal.quantile(u), max);
    }
  }
}

TEST(BoundedNormal, TheLargestDeviationIsThatOfTheUniformOrTheExponentialDistribution) {
  EXPECT_NEAR(BoundedNormal::std_limit(0.5, 0, 1), 1.0 / std::sqrt(12.0), 1e-15);
  EXPECT_NEAR(BoundedNormal::std_limit(3, 2, 1e9), 1.0, 1e-12);
  // Of exp(-2 x) on [0, 1]: 1/4 - e^2 / (e^2 - 1)^2, with the mean 1/2 - 1 / (e^2 - 1).
  const double e = std::exp(2.0);
  EXPECT_NEAR(BoundedNormal::std_limit(0.5 - 1.0 / (e - 1.0), 0, 1),
              std::sqrt(0.25 - e / ((e - 1.0) * (e - 1.0))), 1e-14);
  EXPECT_EQ(BoundedNormal::std_limit(0, 0, 1), 0.0);
}

TEST(BoundedNormal, RefusesWhatNoNormalDistributionHas) {
  const std::string wide = BoundedNormal::error(0.965, 0.2, 0, 1);
  EXPECT_THAT(wide, HasSubstr("no normal distribution within [0, 1] has mean 0.965 and std 0.2"));
  EXPECT_THAT(wide, HasSubstr("std must be below 0.035"));
  EXPECT_THAT(wide, HasSubstr("almost 0.288675"));
  EXPECT_THAT(BoundedNormal::error(0.5, 0.2887, 0, 1), HasSubstr("below 0.288675"));
  EXPECT_EQ(BoundedNormal::error(0.5, 0.28867, 0, 1), "");
  EXPECT_THAT(BoundedNormal::error(1, 0.1, 0, 1), HasSubstr("std must be below 0;"));
  EXPECT_THAT(BoundedNormal::error(1.2, 0, 0, 1), HasSubstr("found 1.2 and [0, 1]"));
  EXPECT_THAT(BoundedNormal::error(0.5, -1, 0, 1), HasSubstr("std >= 0"));
  EXPECT_THAT(BoundedNormal::error(0.5, 0, 1, 0), HasSubstr("min <= max"));
  EXPECT_THAT(BoundedNormal::error(1e308, 1e308, -1e308, 1.1e308), HasSubstr("no normal"));
}

TEST(BoundedNormal, IsDrawnByConfigsWithTheMomentsThatTheyName) {
  constexpr int kBoundedDraws = 4000;
  const auto expander = expander_of(
      fmt::format("seedframe: 1\nseed: 20\nscenes: {}\ncamera: {{distance_m: 1}}\nvariables: "
                  "{{scene: {{x: {{bounded_normal: {{mean: 0.785, std: 0.15, min: 0, max: 1}}}}}}}}"
                  "\n",
                  kBoundedDraws));
  ASSERT_TRUE(expander) << expander.error().message;
  std::vector<double> x;
  double squares = 0.0;
  for (std::int64_t scene = 0; scene < kBoundedDraws; ++scene) {
    const auto frame = expander->expand(scene, {.id = false, .graph = true});
    ASSERT_TRUE(frame) << frame.error().message;
    x.push_back(frame->graph.at("x").get<double>());
    squares += (x.back() - 0.785) * (x.back() - 0.785);
  }
  EXPECT_NEAR(mean_of(x), 0.785, 4.0 * 0.15 / std::sqrt(kBoundedDraws));
  EXPECT_NEAR(std::sqrt(squares / kBoundedDraws), 0.15,
              4.0 * 0.15 / std::sqrt(2.0 * kBoundedDraws));
  const BoundedNormal normal(0.785, 0.15, 0.0, 1.0);
  EXPECT_GT(kolmogorov_p(x, [&](double v) { return normal.share_up_to(v); }), kLeastP);
}

TEST(BoundedNormal, IsRefusedWithTheFrameThatCannotHaveIt) {
  EXPECT_THAT(scene_error("seedframe: 1\nscenes: 3\ncamera: {distance_m: 1}\nvariables: {scene: "
                          "{x: {bounded_normal: [\"0.5 + 0.4 * scene_index\", 0.2, 0, 1]}}}\n"),
              AllOf(HasSubstr("variables.scene.x"), HasSubstr("has mean 0.9 and std 0.2"),
                    HasSubstr("(scene 1, frame 0 of it)")));
}

}  // namespace
}  // namespace seedframe
