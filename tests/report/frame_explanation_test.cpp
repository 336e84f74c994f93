#include "report/frame_explanation.h"

#include <gmock/gmock.h>

#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class FrameExplanationTest : public CampaignFixture {};

TEST_F(FrameExplanationTest, NamesTheFramesThatThereAre) {
  const auto explanation = explain_frame(campaign(), *prepared_, kFrames);
  ASSERT_FALSE(explanation);
  EXPECT_EQ(explanation.error().kind, ErrorKind::kInput);
  EXPECT_THAT(explanation.error().message, HasSubstr("its frames are 0 to 11"));
}

TEST_F(FrameExplanationTest, HasDrawsAttemptsAndWhetherTheFrameIsStillTheSame) {
  ASSERT_TRUE(campaign().store.attempt_started(4, 1, 0, 0.0, R"({"kernel":"avx2"})"));
  const auto explanation = explain_frame(campaign(), *prepared_, 4);
  ASSERT_TRUE(explanation) << explanation.error().message;
  EXPECT_FALSE(explanation->manifest);
  const Json json = to_json(*explanation, "the command");
  EXPECT_EQ(json.at("frame"), 4);
  EXPECT_EQ(json.at("scene"), 1);
  EXPECT_EQ(json.at("unchanged"), true);
  EXPECT_FALSE(json.at("draws").empty());
  EXPECT_EQ(json.at("attempts").at(0).at("provenance").at("kernel"), "avx2");
  EXPECT_EQ(json.at("render_again"), "the command");
  EXPECT_FALSE(json.contains("pixels"));
}

}  // namespace
}  // namespace seedframe
