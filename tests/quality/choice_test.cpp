#include "quality/choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

MeasuredVariation measured(Variation variation, const std::vector<CostAndError>& frames) {
  MeasuredVariation result{std::move(variation), {}, {}};
  for (const CostAndError& each : frames) {
    MeasuredFrame frame;
    frame.cpu_s = each.cost;
    frame.error.display.mse = each.error * each.error;
    result.frames.push_back(frame);
  }
  return result;
}

Variation denoised(int samples) {
  Variation variation = plain_samples(samples);
  variation.name += ", oidn";
  variation.lever = Lever::kDenoise;
  return variation;
}

const Measure& codes() { return measure_named("rmse8"); }

TEST(Choices, HaveTheMeanCostAndTheRootOfTheMeanSquareOverFrames) {
  SceneStudy scene;
  scene.variations = {measured(plain_samples(4), {{1.0, 3.0}, {3.0, 4.0}})};
  const std::vector<Choice> choices = choices_of(scene, codes());
  ASSERT_EQ(choices.size(), 1u);
  EXPECT_DOUBLE_EQ(choices[0].at.cost, 2.0);
  EXPECT_DOUBLE_EQ(choices[0].at.error, std::sqrt(12.5));
}

TEST(Choices, LackWhatWasLeftOut) {
  SceneStudy scene;
  scene.variations = {measured(plain_samples(4), {{1.0, 3.0}}), measured(plain_samples(8), {})};
  scene.variations[1].left_out = "no time";
  EXPECT_EQ(choices_of(scene, codes()).size(), 1u);
}

TEST(ChoicesOverall, AreGeometricMeansOverTheFramesOfAllScenes) {
  SceneStudy bright;
  bright.variations = {measured(plain_samples(16), {{2.0, 4.0}}),
                       measured(plain_samples(64), {{8.0, 2.0}})};
  SceneStudy dark;
  dark.variations = {measured(plain_samples(16), {{1.0, 1.0}}),
                     measured(plain_samples(64), {{1.0, 0.125}})};
  const std::vector<Choice> choices = choices_overall({bright, dark}, codes());
  ASSERT_EQ(choices.size(), 2u);
  EXPECT_DOUBLE_EQ(choices[0].at.cost, 1.0);
  EXPECT_DOUBLE_EQ(choices[0].at.error, 1.0);
  EXPECT_DOUBLE_EQ(choices[1].at.cost, 2.0);    // of 4 and 1
  EXPECT_DOUBLE_EQ(choices[1].at.error, 0.25);  // of 1/2 and 1/8
}

TEST(ChoicesOverall, LackWhatOneOfTheScenesLacks) {
  SceneStudy one;
  one.variations = {measured(plain_samples(16), {{2.0, 4.0}}),
                    measured(plain_samples(64), {{8.0, 2.0}})};
  SceneStudy other;
  other.variations = {measured(plain_samples(16), {{1.0, 1.0}}), measured(plain_samples(64), {})};
  other.variations[1].left_out = "no time";
  EXPECT_EQ(choices_overall({one, other}, codes()).size(), 1u);
  other.variations.erase(other.variations.begin());
  EXPECT_THAT(choices_overall({one, other}, codes()), IsEmpty());
  EXPECT_THAT(choices_overall({}, codes()), IsEmpty());
}

TEST(Front, LeavesDenoisedOnesOutIfTheyMayNotBe) {
  SceneStudy scene;
  scene.variations = {measured(plain_samples(4), {{1.0, 8.0}}), measured(denoised(4), {{1.1, 2.0}}),
                      measured(plain_samples(16), {{4.0, 4.0}})};
  const std::vector<Choice> choices = choices_of(scene, codes());
  EXPECT_THAT(front_of(choices, true), ElementsAre(0, 1));
  EXPECT_THAT(front_of(choices, false), ElementsAre(0, 2));
}

TEST(Advice, NamesTheCheapestThatIsAsGoodAsPlainSamples) {
  SceneStudy scene;
  Variation adaptive = plain_samples(64);
  adaptive.name = "adaptive";
  adaptive.lever = Lever::kAdaptive;
  scene.variations = {measured(plain_samples(4), {{1.0, 8.0}}), measured(denoised(4), {{1.1, 2.0}}),
                      measured(adaptive, {{3.0, 4.0}}), measured(plain_samples(16), {{4.0, 4.0}})};
  const std::vector<Advice> advice = advice_for(choices_of(scene, codes()));
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_EQ(advice[0].plain.name, "4 samples");
  EXPECT_EQ(advice[0].exact.name, "4 samples");
  EXPECT_EQ(advice[0].denoised.name, "4 samples");
  EXPECT_EQ(advice[1].plain.name, "16 samples");
  EXPECT_EQ(advice[1].exact.name, "adaptive");
  EXPECT_EQ(advice[1].denoised.name, "4 samples, oidn");
}

}  // namespace
}  // namespace seedframe
