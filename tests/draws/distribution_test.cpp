// What is drawn, from the text of a config to the values of its variables, against the theory.

#include <cmath>

#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/poisson.hpp>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"
#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

constexpr int kDraws = 20'000;

/// The values of variable "x" in all scenes of a config that defines it in `variables.scene`.
std::vector<double> draws_of(const std::string& definition,
                             const std::filesystem::path& file = "scene.yaml") {
  auto expander =
      expander_of("seedframe: 1\nseed: 20\nscenes: " + std::to_string(kDraws) +
                      "\ncamera: {distance_m: 1}\nvariables: {scene: {x: " + definition + "}}\n",
                  file);
  EXPECT_TRUE(expander) << expander.error().message;
  std::vector<double> values;
  if (!expander) return {0.0};
  for (std::int64_t scene = 0; scene < kDraws; ++scene) {
    const auto frame = expander->expand(scene, {.id = false, .graph = true});
    EXPECT_TRUE(frame) << frame.error().message;
    if (!frame) break;
    values.push_back(frame->graph.at("x").get<double>());
  }
  return values;
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// How often each of the whole numbers 0 … size−1 stands among the values; others count for the
/// last.
std::vector<double> counts_of(const std::vector<double>& values, std::size_t size) {
  std::vector<double> counts(size, 0.0);
  for (const double value : values) {
    EXPECT_EQ(value, std::floor(value));
    counts[std::min(static_cast<std::size_t>(value), size - 1)] += 1.0;
  }
  return counts;
}

std::vector<double> times(std::vector<double> shares, double total) {
  for (double& share : shares) share *= total;
  return shares;
}

TEST(Distribution, Uniform) {
  const std::vector<double> x = draws_of("{uniform: [-2, 3]}");
  EXPECT_GT(kolmogorov_p(x, [](double v) { return (v + 2.0) / 5.0; }), kLeastP);
  EXPECT_GE(*std::min_element(x.begin(), x.end()), -2.0);
  EXPECT_LE(*std::max_element(x.begin(), x.end()), 3.0);
}

TEST(Distribution, Normal) {
  const std::vector<double> x = draws_of("{normal: [10, 2]}");
  EXPECT_GT(kolmogorov_p(x, [](double v) { return normal_cdf((v - 10.0) / 2.0); }), kLeastP);
}

TEST(Distribution, TruncatedNormal) {
  const double low = normal_cdf(-1.0);
  const double high = normal_cdf(0.5);
  const std::vector<double> x = draws_of("{truncated_normal: [10, 2, 8, 11]}");
  EXPECT_GT(kolmogorov_p(
                x, [&](double v) { return (normal_cdf((v - 10.0) / 2.0) - low) / (high - low); }),
            kLeastP);
  EXPECT_GE(*std::min_element(x.begin(), x.end()), 8.0);
  EXPECT_LE(*std::max_element(x.begin(), x.end()), 11.0);
}

TEST(Distribution, LogUniform) {
  const std::vector<double> x = draws_of("{log_uniform: [0.01, 100]}");
  EXPECT_GT(kolmogorov_p(x, [](double v) { return std::log(v / 0.01) / std::log(1e4); }), kLeastP);
}

TEST(Distribution, AMixtureHasItsPartsByWeight) {
  const std::vector<double> x = draws_of(
      "{mixture: [{value: {normal: [0, 1]}, weight: 3}, {value: {uniform: [4, 6]}, weight: 1}]}");
  EXPECT_GT(kolmogorov_p(x,
                         [](double v) {
                           return 0.75 * normal_cdf(v) +
                                  0.25 * std::clamp((v - 4.0) / 2.0, 0.0, 1.0);
                         }),
            kLeastP);
}

TEST(Distribution, ParametersMayBeDistributions) {
  // A normal with a normal mean is a wider normal.
  const std::vector<double> x = draws_of("{normal: [{normal: [1, 3]}, 4]}");
  EXPECT_GT(kolmogorov_p(x, [](double v) { return normal_cdf((v - 1.0) / 5.0); }), kLeastP);
}

TEST(Distribution, Integer) {
  const std::vector<double> x = draws_of("{integer: [0, 12]}");
  EXPECT_GT(chi_squared_p(counts_of(x, 13), std::vector<double>(13, kDraws / 13.0)), kLeastP);
}

TEST(Distribution, IntegerStartsWhereItIsTold) {
  std::vector<double> x = draws_of("{integer: [-3, -1]}");
  for (double& v : x) v += 3.0;
  EXPECT_GT(chi_squared_p(counts_of(x, 3), std::vector<double>(3, kDraws / 3.0)), kLeastP);
}

TEST(Distribution, Poisson) {
  const boost::math::poisson theory(3.7);
  std::vector<double> expected;
  for (int k = 0; k < 11; ++k) expected.push_back(kDraws * boost::math::pdf(theory, k));
  expected.push_back(kDraws * boost::math::cdf(boost::math::complement(theory, 10)));
  EXPECT_GT(chi_squared_p(counts_of(draws_of("{poisson: 3.7}"), 12), expected), kLeastP);
}

TEST(Distribution, PoissonAtTheEndsOfItsRange) {
  const std::vector<double> none = draws_of("{poisson: 0}");
  EXPECT_EQ(*std::max_element(none.begin(), none.end()), 0.0);
  // So many that it is nearly normal; half a step is what the whole numbers hide.
  const std::vector<double> many = draws_of("{poisson: 10000}");
  EXPECT_NEAR(mean_of(many), 10000.0, 4.0 * 100.0 / std::sqrt(kDraws));
  EXPECT_LT(kolmogorov_distance(many, [](double v) { return normal_cdf((v + 0.5 - 1e4) / 100.0); }),
            0.02);
}

TEST(Distribution, ChoiceFollowsItsWeights) {
  const std::vector<double> x = draws_of("{choice: {0: 1, 1: 2, 2: 0, 3: 5.5, 4: 1.5}}");
  std::vector<double> counts = counts_of(x, 5);
  EXPECT_EQ(counts[2], 0.0);
  counts.erase(counts.begin() + 2);
  EXPECT_GT(chi_squared_p(counts, times({0.1, 0.2, 0.55, 0.15}, kDraws)), kLeastP);
}

TEST(Distribution, WeightsMayBeFormulasAndDistributions) {
  const std::vector<double> x =
      draws_of("{choice: [{value: 0, weight: \"2 - 1\"}, {value: 1, weight: {integer: [1, 2]}}]}");
  // Half of the scenes weigh 1 : 1, half 1 : 2.
  const double zeros = 0.5 * (1.0 / 2.0) + 0.5 * (1.0 / 3.0);
  EXPECT_GT(chi_squared_p(counts_of(x, 2), times({zeros, 1.0 - zeros}, kDraws)), kLeastP);
}

TEST(Distribution, EmpiricalTakesEachSampleAsOften) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "sizes.csv", "name,size\na,2\nb,0\nc,2\nd,1\ne,3\n"));
  const std::vector<double> x = draws_of("{empirical: [sizes.csv, size]}", folder / "scene.yaml");
  EXPECT_GT(chi_squared_p(counts_of(x, 4), times({0.2, 0.2, 0.4, 0.2}, kDraws)), kLeastP);
}

TEST(Distribution, SobolIsEvenerThanChance) {
  const auto distance = [](const char* definition) {
    return kolmogorov_distance(draws_of(definition),
                               [](double v) { return normal_cdf((v - 10.0) / 2.0); });
  };
  // Random draws are off by about 0.87/√n = 0.006.
  EXPECT_GT(distance("{normal: [10, 2]}"), 0.002);
  EXPECT_LT(distance("{sobol: [0, {normal: [10, 2]}]}"), 0.0005);
  EXPECT_LT(distance("{sobol: {dimension: 40, of: {normal: [10, 2]}}}"), 0.0005);
}

TEST(Distribution, SobolPutsOneSceneOfEachBlockIntoEachPart) {
  const std::vector<double> x = draws_of("{sobol: [3, {uniform: [0, 64]}]}");
  for (std::size_t block = 0; block < 300; ++block) {
    std::vector<double> parts;
    for (std::size_t i = 0; i < 64; ++i) parts.push_back(std::floor(x[64 * block + i]));
    const std::vector<double> counts = counts_of(parts, 64);
    EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), 1.0) << block;
  }
}

TEST(Distribution, SobolOfAChoiceAndOfAnIntegerKeepsTheirShares) {
  const std::vector<double> a = counts_of(draws_of("{sobol: [1, {choice: {0: 1, 1: 3}}]}"), 2);
  EXPECT_NEAR(a[0], kDraws / 4.0, 8.0);
  const std::vector<double> b = counts_of(draws_of("{sobol: [2, {integer: [0, 9]}]}"), 10);
  for (const double count : b) EXPECT_NEAR(count, kDraws / 10.0, 8.0);
}

}  // namespace
}  // namespace seedframe
