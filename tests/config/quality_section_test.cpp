// The section `quality`: how wrong frames may be.

#include "config/quality_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

Result<CampaignConfig> read_quality_of(const std::string& sections) {
  return read_campaign_config("seedframe: 1\ncamera: {distance_m: 1}\n" + sections + "\n",
                              "q.yaml");
}

std::string refusal_of_quality(const std::string& sections) {
  return message_of(read_quality_of(sections));
}

TEST(QualitySection, IsNotThereUnlessAskedFor) {
  EXPECT_EQ(read_quality_of("")->quality, std::nullopt);
  EXPECT_EQ(read_quality_of("quality: null")->quality, std::nullopt);
}

TEST(QualitySection, SaysWhatIsBounded) {
  const auto config = read_quality_of("quality: {metric: relmse, max_error: 0.01}");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->quality, (QualityWish{QualityMetric::kRelMse, 0.01, 0.95, false}));
  EXPECT_EQ(
      read_quality_of("quality: {metric: psnr, max_error: 32, share: 0.9, denoise: auto}")->quality,
      (QualityWish{QualityMetric::kPsnr, 32.0, 0.9, true}));
}

TEST(QualitySection, NeedsAMetricAndABound) {
  EXPECT_THAT(refusal_of_quality("quality: {max_error: 1}"), HasSubstr("metric"));
  EXPECT_THAT(refusal_of_quality("quality: {metric: flip}"), HasSubstr("max_error"));
  EXPECT_THAT(refusal_of_quality("quality: {metric: flipp, max_error: 1}"),
              HasSubstr("expected one of relmse, flip, psnr, rmse8, found 'flipp' (did you mean "
                        "'flip'?)"));
  EXPECT_THAT(refusal_of_quality("quality: {metric: flip, max_error: 0}"), HasSubstr("above 0"));
  EXPECT_THAT(refusal_of_quality("quality: {metric: flip, max_error: 1, share: 1}"),
              HasSubstr("expected less than 1"));
  EXPECT_THAT(refusal_of_quality("quality: {metric: flip, max_error: 1, denoise: yes}"),
              HasSubstr("expected auto or off"));
}

TEST(QualitySection, StandsForWhatItChooses) {
  EXPECT_THAT(refusal_of_quality("quality: {metric: flip, max_error: 1}\nrender: {denoise: oidn}"),
              HasSubstr("leave render.adaptive and render.denoise out"));
  EXPECT_THAT(refusal_of_quality("quality: {metric: flip, max_error: 1}\n"
                                 "render: {adaptive: {threshold: 0.1, min_samples: 4}}"),
              HasSubstr("leave render.adaptive and render.denoise out"));
  EXPECT_THAT(refusal_of_quality("quality: {metric: flip, max_error: 1}\nlabels: geometry"),
              HasSubstr("there are no pictures"));
}

}  // namespace
}  // namespace seedframe
