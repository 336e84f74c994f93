#include "quality/variation.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "quality/error_study.h"
#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;

constexpr const char* kConfig = R"(seedframe: 1
name: pilots
scenes: 5
frames_per_scene: 2
categories: [gear]
render: {width: 32, height: 24, samples: 99, max_bounces: 3, adaptive: {threshold: 0.1, min_samples: 5},
         denoise: oidn, light_threshold: 0.5, clamp_indirect: 7}
objects: {gears: {asset: gear, count: 2, scatter: {x: [-0.2, 0.2], y: [-0.2, 0.2]}}}
camera: {position: [0, 0, 1], target: [0, 0, 0]}
)";

PreparedCampaign prepared_with(const std::vector<Override>& set) {
  Result<PreparedCampaign> prepared =
      prepare({kConfig, "pilots.yaml", set, SEEDFRAME_HOME, AllowedFolders({"."})});
  EXPECT_TRUE(prepared) << message_of(prepared);
  return std::move(*prepared);
}

std::vector<ExpandedFrame> one_pilot() {
  std::vector<ExpandedFrame> pilots;
  pilots.push_back(std::move(*prepared_with({}).expander.expand(0)));
  return pilots;
}

std::vector<std::string> names_of(const std::vector<Variation>& grid) {
  std::vector<std::string> names;
  for (const Variation& variation : grid) names.push_back(variation.name);
  return names;
}

TEST(PlainSamples, TakeBackWhatTheConfigHasOfOtherLevers) {
  const RenderSettings render = prepared_with(plain_samples(8).set).settings.render;
  EXPECT_EQ(render.samples, 8);
  EXPECT_EQ(render.adaptive, AdaptiveSampling());
  EXPECT_EQ(render.denoise, Denoise::kOff);
  EXPECT_EQ(render.levers, RenderLevers());
  EXPECT_EQ(render.max_bounces, 3);
  EXPECT_EQ(render.clamp_indirect, 7.0);
}

TEST(ReferenceVariation, ClampsNothing) {
  const RenderSettings render = prepared_with(reference_variation(512).set).settings.render;
  EXPECT_EQ(render.samples, 512);
  EXPECT_EQ(render.clamp_indirect, 0.0);
  EXPECT_EQ(render.levers, RenderLevers());
  EXPECT_EQ(render.max_bounces, 3);
}

TEST(VariationGrid, HasOnlyWhatAConfigCanSay) {
  for (const Variation& variation : variation_grid(one_pilot(), 1024)) {
    SCOPED_TRACE(variation.name);
    prepared_with(variation.set);
  }
}

TEST(VariationGrid, HasEveryNameOnce) {
  const std::vector<std::string> names = names_of(variation_grid(one_pilot(), 1024));
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(VariationGrid, GoesUpToTheMostSamples) {
  const std::vector<std::string> all = names_of(variation_grid(one_pilot(), 1024));
  EXPECT_THAT(all, Contains("1024 samples"));
  const std::vector<std::string> few = names_of(variation_grid(one_pilot(), 16));
  EXPECT_THAT(few, Contains("16 samples"));
  EXPECT_THAT(few, Not(Contains("32 samples")));
}

TEST(VariationGrid, TriesOnlyWhatTheFramesHave) {
  const std::vector<std::string> names = names_of(variation_grid(one_pilot(), 16));
  EXPECT_THAT(names, Not(Contains("16 samples, importance_map_px 256")));
  EXPECT_THAT(names, Not(Contains("16 samples, texture_limit_px 256")));
  EXPECT_THAT(names, Contains("16 samples, detail auto"));
}

TEST(PilotFrames, AreSpreadOverTheCampaign) {
  EXPECT_THAT(pilot_frames(10, 1), ElementsAre(5));
  EXPECT_THAT(pilot_frames(30, 3), ElementsAre(5, 15, 25));
  EXPECT_THAT(pilot_frames(3, 3), ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace seedframe
