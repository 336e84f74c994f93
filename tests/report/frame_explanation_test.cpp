#include "report/frame_explanation.h"

#include <algorithm>

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
  const Json json = to_json(*explanation, {"gear"}, "the command");
  EXPECT_EQ(json.at("frame"), 4);
  EXPECT_EQ(json.at("scene"), 1);
  EXPECT_EQ(json.at("unchanged"), true);
  EXPECT_FALSE(json.at("draws").empty());
  EXPECT_EQ(json.at("attempts").at(0).at("provenance").at("kernel"), "avx2");
  EXPECT_EQ(json.at("render_again"), "the command");
  EXPECT_FALSE(json.contains("pixels"));
}

TEST_F(FrameExplanationTest, SaysWhereEachObjectIsInTheWorld) {
  const auto explanation = explain_frame(campaign(), *prepared_, 4);
  ASSERT_TRUE(explanation) << explanation.error().message;
  const auto objects = explained_objects(*explanation, {"gear"});
  const auto& instances = explanation->expanded.spec.instances;
  ASSERT_FALSE(objects.empty());
  for (const ExplainedObject& object : objects) {
    const auto instance = std::find_if(instances.begin(), instances.end(),
                                       [&](const auto& each) { return each.id == object.id; });
    ASSERT_NE(instance, instances.end());
    EXPECT_EQ(object.name, instance->name);
    EXPECT_EQ(object.asset, "gear");
    EXPECT_EQ(object.category, "gear");
    EXPECT_NEAR(object.distance_m,
                (object.position - explanation->expanded.world_from_camera.translation()).norm(),
                1e-9);
    EXPECT_EQ(object.visible_px, std::nullopt) << "nothing is rendered";
  }
}

}  // namespace
}  // namespace seedframe
