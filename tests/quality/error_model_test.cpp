#include "quality/error_model.h"

#include <cmath>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

/// Errors of which the model is true: they fall with the root of the samples and rise with the
/// scout.
std::vector<Observation> exact(double slope = 1.0) {
  std::vector<Observation> observations;
  for (const double scout : {2.0, 3.0, 5.0}) {
    for (const double samples : {1.0, 4.0, 16.0, 64.0}) {
      observations.push_back({scout, samples, 3.0 * std::pow(scout, slope) / std::sqrt(samples)});
    }
  }
  return observations;
}

TEST(ErrorModel, FindsWhatIsThere) {
  const ErrorModel model(exact());
  ASSERT_TRUE(model.is_usable());
  EXPECT_NEAR(model.slope(), 1.0, 1e-12);
  EXPECT_NEAR(model.predict(4.0, 16.0), 3.0, 1e-12);
  EXPECT_NEAR(model.predict(4.0, 9.0), 4.0, 1e-12);     // between what was observed
  EXPECT_NEAR(model.predict(4.0, 256.0), 0.75, 1e-12);  // and beyond
  EXPECT_NEAR(model.predict(4.0, 0.25), 24.0, 1e-12);
  EXPECT_EQ(model.spread(), 0.1);
}

TEST(ErrorModel, FitsHowMuchTheScoutTells) {
  EXPECT_NEAR(ErrorModel(exact(0.4)).slope(), 0.4, 1e-12);
  EXPECT_EQ(ErrorModel(exact(-1.0)).slope(), 0.0);
  EXPECT_EQ(ErrorModel(exact(3.0)).slope(), 1.5);
}

TEST(ErrorModel, ASettingMayHaveASlopeOfItsOwn) {
  std::vector<Observation> observations;
  for (const double scout : {1.0, 2.0, 4.0}) {
    observations.push_back({scout, 1.0, scout});  // slope 1
    observations.push_back({scout, 2.0, 1.0});    // and 0
  }
  const ErrorModel model(observations);
  EXPECT_NEAR(model.slope(), 0.5, 1e-12);
  EXPECT_NEAR(model.predict(4.0, 1.0) / model.predict(1.0, 1.0), std::pow(4.0, 0.75), 1e-12);
  EXPECT_NEAR(model.predict(4.0, 2.0) / model.predict(1.0, 2.0), std::pow(4.0, 0.25), 1e-12);
}

TEST(ErrorModel, KnowsHowFarItIsOff) {
  std::vector<Observation> observations = exact();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    observations[i].error *= i % 3 == 0 ? 1.3 : 1.0 / 1.3;
  }
  const double spread = ErrorModel(observations).spread();
  EXPECT_GT(spread, 0.15);
  EXPECT_LT(spread, 0.4);
}

TEST(ErrorModel, IsOfNoUseWithOneSetting) {
  EXPECT_FALSE(ErrorModel({}).is_usable());
  EXPECT_FALSE(ErrorModel({{1.0, 4.0, 1.0}, {2.0, 4.0, 2.0}}).is_usable());
  EXPECT_TRUE(ErrorModel({{1.0, 4.0, 1.0}, {2.0, 8.0, 2.0}}).is_usable());
}

TEST(ErrorModel, LeavesOutWhatHasNoLogarithm) {
  std::vector<Observation> observations = exact();
  observations.push_back({0.0, 16.0, 1.0});
  observations.push_back({1.0, 16.0, 0.0});
  observations.push_back({std::nan(""), 16.0, 1.0});
  EXPECT_NEAR(ErrorModel(observations).predict(4.0, 16.0), 3.0, 1e-12);
}

TEST(SettingFor, MeetsTheBound) {
  const ErrorModel model(exact());
  // 3 · 4 / √n · 1.5 = 2: n = 81.
  EXPECT_NEAR(setting_for(model, 4.0, 2.0, 1.5, 1.0, 1024.0, false), 81.0, 1e-6);
  EXPECT_NEAR(setting_for(model, 4.0, 1e-6, 1.5, 1.0, 1024.0, false), 1024.0, 1e-6);
  EXPECT_NEAR(setting_for(model, 4.0, 1e6, 1.5, 1.0, 1024.0, false), 1.0, 1e-6);
}

TEST(SettingFor, MeetsTheBoundOfErrorsThatRise) {
  std::vector<Observation> observations;
  for (const double threshold : {0.01, 0.1, 1.0}) {
    observations.push_back({1.0, threshold, 10.0 * threshold});
    observations.push_back({2.0, threshold, 20.0 * threshold});
  }
  const ErrorModel model(observations);
  EXPECT_NEAR(setting_for(model, 2.0, 2.0, 1.0, 0.001, 1.0, true), 0.1, 1e-9);
  EXPECT_NEAR(setting_for(model, 2.0, 1e-9, 1.0, 0.001, 1.0, true), 0.001, 1e-9);
  EXPECT_NEAR(setting_for(model, 2.0, 1e9, 1.0, 0.001, 1.0, true), 1.0, 1e-9);
}

TEST(NormalQuantile, IsThatOfTheTables) {
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-12);
  EXPECT_NEAR(normal_quantile(0.95), 1.6448536269514722, 1e-12);
  EXPECT_NEAR(normal_quantile(0.05), -1.6448536269514722, 1e-12);
}

}  // namespace
}  // namespace seedframe
