#include "config/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

TEST(Settings, HaveAllThatAConfigSaysOfEveryFrame) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "other.ocio", ""));
  const auto config = read_campaign_config(R"(seedframe: 1
name: nuts
seed: 11
scenes: 5
frames_per_scene: 3
categories: [gear, hex_nut]
render: {width: 321, height: 123, samples: 7, max_bounces: 2, filter_width_px: 1.25,
         clamp_indirect: 4, passes: [depth, normal], persistent_data: true,
         adaptive: {threshold: 0.1, min_samples: 5}, denoise: oidn_fast, light_threshold: 0.5}
determinism: none
image: {display: XYZ, view: Raw, look: High, exposure_stops: 1, gamma: 2, ocio_config: other.ocio,
        format: webp}
labels: {source: geometry, check: false, tolerance: 0.5, edge_tolerance: 0.25}
camera: {distance_m: 1}
)",
                                           folder / "s.yaml");
  ASSERT_TRUE(config) << config.error().message;
  const CampaignSettings settings = settings_of(*config);
  EXPECT_EQ(settings.name, "nuts");
  EXPECT_EQ(settings.seed, 11u);
  EXPECT_EQ(settings.scenes, 5);
  EXPECT_EQ(settings.frames_per_scene, 3);
  EXPECT_EQ(settings.frame_count(), 15);
  EXPECT_THAT(settings.categories, ::testing::ElementsAre("gear", "hex_nut"));
  EXPECT_EQ(settings.render.width, 321);
  EXPECT_EQ(settings.render.height, 123);
  EXPECT_EQ(settings.render.samples, 7);
  EXPECT_EQ(settings.render.max_bounces, 2);
  EXPECT_EQ(settings.render.adaptive, (AdaptiveSampling{0.1, 5}));
  EXPECT_EQ(settings.render.denoise, Denoise::kOidnFast);
  EXPECT_EQ(settings.render.filter_width_px, 1.25);
  EXPECT_EQ(settings.render.clamp_indirect, 4.0);
  EXPECT_EQ(settings.render.levers.light_threshold, 0.5);
  EXPECT_TRUE(settings.render.depth);
  EXPECT_TRUE(settings.render.normal);
  EXPECT_TRUE(settings.persistent_data);
  EXPECT_EQ(settings.determinism.mode, Determinism::Mode::kNone);
  EXPECT_EQ(settings.image.display, "XYZ");
  EXPECT_EQ(settings.image.view, "Raw");
  EXPECT_EQ(settings.image.look, "High");
  EXPECT_EQ(settings.image.exposure_stops, 1.0);
  EXPECT_EQ(settings.image.gamma, 2.0);
  EXPECT_EQ(settings.ocio_config, folder / "other.ocio");
  EXPECT_EQ(settings.image_encoding.format, ImageFormat::kWebp);
  EXPECT_EQ(settings.image_place.line, 11);
  EXPECT_EQ(settings.labels, LabelSource::kTwin);
  EXPECT_FALSE(settings.twin_check.wanted);
  EXPECT_EQ(settings.twin_check.tolerance.inside_share, 0.5);
  EXPECT_EQ(settings.twin_check.tolerance.outline_share, 0.25);
}

}  // namespace
}  // namespace seedframe
