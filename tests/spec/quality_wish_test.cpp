#include "spec/quality_wish.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::HasSubstr;

TEST(RenderChoices, SurviveTheirJson) {
  const RenderChoices choices = {{0, {1, {}, Denoise::kOff}},
                                 {7, {256, {0.05, 16}, Denoise::kOff}},
                                 {123456789012, {4, {}, Denoise::kOidnFast}}};
  const auto read = render_choices_from_json(to_json(choices), "c");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, choices);
  EXPECT_EQ(render_choices_from_json(to_json(RenderChoices()), "c"), RenderChoices());
}

TEST(RenderChoices, ThatAreDamagedAreErrors) {
  const auto refusal = [](const char* text) {
    const auto read = render_choices_from_json(Json::parse(text), "the store");
    EXPECT_FALSE(read) << text;
    return read ? std::string() : read.error().message;
  };
  EXPECT_THAT(refusal(R"({"version": 2, "frames": {}})"),
              HasSubstr("the store are choices of version 2"));
  EXPECT_THAT(refusal(R"({"version": 1})"), HasSubstr("the store"));
  EXPECT_THAT(refusal(R"({"version": 1, "frames": {"1x": {"samples": 1}}})"), HasSubstr("1x"));
  EXPECT_THAT(refusal(R"({"version": 1, "frames": {"1": {}}})"), HasSubstr("samples"));
  EXPECT_THAT(refusal(R"({"version": 1, "frames": {"1": {"samples": 1, "denoise": "x"}}})"),
              HasSubstr("unknown denoiser 'x'"));
}

TEST(QualityWish, SurvivesItsJson) {
  const QualityWish wish = {QualityMetric::kFlip, 0.125, 0.9, true};
  const auto read = quality_wish_from_json(to_json(wish), "c");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, wish);
}

TEST(QualityWish, ThatIsDamagedIsAnError) {
  const Json whole = to_json(QualityWish{QualityMetric::kRmse8, 4.0, 0.95, false});
  for (const auto& [key, value] : whole.items()) {
    Json damaged = whole;
    damaged.erase(key);
    EXPECT_FALSE(quality_wish_from_json(damaged, "c")) << "without " << key;
    damaged[key] = Json::array();
    EXPECT_FALSE(quality_wish_from_json(damaged, "c")) << "with another " << key;
  }
  Json other = whole;
  other["metric"] = "beauty";
  EXPECT_THAT(quality_wish_from_json(other, "c").error().message,
              HasSubstr("c: unknown metric 'beauty'"));
}

TEST(ErrorBound, OfAPsnrIsTheRmseThatItMeans) {
  const ErrorBound bound = error_bound({QualityMetric::kPsnr, 40.0});
  EXPECT_EQ(bound.metric, QualityMetric::kRmse8);
  EXPECT_NEAR(bound.max_error, 2.55, 1e-12);
  EXPECT_EQ(error_bound({QualityMetric::kFlip, 0.1}).max_error, 0.1);
}

}  // namespace
}  // namespace seedframe
