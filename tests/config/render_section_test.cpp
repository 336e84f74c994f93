// The section `render`: what it is without a word, and what is refused.

#include "config/render_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

Result<CampaignConfig> read_rendering(const std::string& render) {
  return read_campaign_config("seedframe: 1\ncamera: {distance_m: 1}\nrender: {" + render + "}\n",
                              "r.yaml");
}

std::string refusal_of_rendering(const std::string& render) {
  const auto config = read_rendering(render);
  return message_of(config);
}

TEST(RenderSection, RendersEverySampleOfEveryPixelUnlessSaidOtherwise) {
  const auto config = read_rendering("samples: 9");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->render.adaptive, AdaptiveSampling());
  EXPECT_EQ(config->render.denoise, Denoise::kOff);
}

TEST(RenderSection, AdaptiveSamplingNamesItsThresholdAndItsMinimum) {
  const auto config = read_rendering("samples: 64, adaptive: {threshold: 0.05, min_samples: 64}");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->render.adaptive, (AdaptiveSampling{0.05, 64}));
  EXPECT_THAT(refusal_of_rendering("adaptive: {threshold: 0.05}"), HasSubstr("min_samples"));
  EXPECT_THAT(refusal_of_rendering("adaptive: {min_samples: 4}"), HasSubstr("threshold"));
  EXPECT_THAT(refusal_of_rendering("adaptive: {threshold: 0, min_samples: 4}"),
              HasSubstr("render.adaptive.threshold"));
  EXPECT_THAT(refusal_of_rendering("adaptive: {threshold: 1, min_samples: 0}"),
              HasSubstr("render.adaptive.min_samples"));
  EXPECT_THAT(refusal_of_rendering("samples: 8, adaptive: {threshold: 0.1, min_samples: 16}"),
              HasSubstr("render.adaptive: min_samples of 16 are more than render.samples, 8"));
}

TEST(RenderSection, ADenoiserIsOneOfThree) {
  EXPECT_EQ(read_rendering("denoise: oidn")->render.denoise, Denoise::kOidn);
  EXPECT_EQ(read_rendering("denoise: oidn_fast")->render.denoise, Denoise::kOidnFast);
  EXPECT_EQ(read_rendering("denoise: off")->render.denoise, Denoise::kOff);
  EXPECT_THAT(refusal_of_rendering("denoise: oidn_fats"),
              HasSubstr("render.denoise: expected one of off, oidn, oidn_fast, found 'oidn_fats' "
                        "(did you mean 'oidn_fast'?)"));
}

TEST(RenderSection, LeversAreOffUnlessSaidOtherwise) {
  EXPECT_EQ(read_rendering("samples: 9")->render.levers, RenderLevers());
  const auto config = read_rendering(
      "max_bounces: 4, bounces: {diffuse: 0, transparent: 4}, light_threshold: 0.01, "
      "clamp_direct: 8, filter_glossy: 0.5, texture_limit_px: 512");
  ASSERT_TRUE(config) << config.error().message;
  const RenderLevers expected{{0, std::nullopt, std::nullopt, 4}, 0.01, 8.0, 0.5, 512, false};
  EXPECT_EQ(config->render.levers, expected);
}

TEST(RenderSection, LeversOutOfTheirRangeAreRefused) {
  EXPECT_THAT(refusal_of_rendering("max_bounces: 4, bounces: {glossy: 5}"),
              HasSubstr("render.bounces.glossy"));
  EXPECT_THAT(refusal_of_rendering("bounces: {volume: 1}"), HasSubstr("render.bounces"));
  EXPECT_THAT(refusal_of_rendering("light_threshold: -1"), HasSubstr("render.light_threshold"));
  EXPECT_THAT(refusal_of_rendering("clamp_direct: -1"), HasSubstr("render.clamp_direct"));
  EXPECT_THAT(refusal_of_rendering("filter_glossy: -1"), HasSubstr("render.filter_glossy"));
  EXPECT_THAT(refusal_of_rendering("texture_limit_px: 100"),
              HasSubstr("expected 0 (no limit) or a power of two from 128 to 8192, found 100"));
  EXPECT_THAT(refusal_of_rendering("texture_limit_px: 64"), HasSubstr("found 64"));
}

TEST(RenderSection, WhatBlenderWouldLimitWithoutAWordIsRefused) {
  EXPECT_THAT(refusal_of_rendering("filter_width_px: 11"),
              HasSubstr("render.filter_width_px: expected a number from 0.01 to 10, found 11"));
  EXPECT_THAT(refusal_of_rendering("filter_width_px: 0.001"), HasSubstr("found 0.001"));
  EXPECT_THAT(refusal_of_rendering("samples: 9999, adaptive: {threshold: 0.1, min_samples: 5000}"),
              HasSubstr("render.adaptive.min_samples: expected a whole number from 1 to 4096"));
  EXPECT_THAT(refusal_of_rendering("adaptive: {threshold: 2, min_samples: 4}"),
              HasSubstr("render.adaptive.threshold: expected a number from 0 to 1, found 2"));
  EXPECT_THAT(refusal_of_rendering("light_threshold: 2"),
              HasSubstr("render.light_threshold: expected 0 (off) to 1, found 2"));
  EXPECT_THAT(refusal_of_rendering("filter_glossy: 11"), HasSubstr("expected 0 (off) to 10"));
  EXPECT_THAT(refusal_of_rendering("clamp_direct: 1e9"), HasSubstr("expected 0 (off) to 1e+08"));
  EXPECT_THAT(refusal_of_rendering("clamp_indirect: 1e9"), HasSubstr("render.clamp_indirect"));
}

TEST(RenderSection, PathGuidingPromisesNothing) {
  EXPECT_THAT(refusal_of_rendering("path_guiding: true"), HasSubstr("determinism: none"));
  EXPECT_TRUE(read_rendering("path_guiding: true}\ndeterminism: none\nimage: {gamma: 1")
                  ->render.levers.path_guiding);
}

TEST(RenderSection, TheDeviceIsTheCpuUnlessSaidOtherwise) {
  EXPECT_EQ(read_rendering("samples: 9")->render.device, RenderDevice::kCpu);
  EXPECT_EQ(read_rendering("device: oneapi")->render.device, RenderDevice::kOneapi);
  EXPECT_THAT(
      refusal_of_rendering("device: cude"),
      HasSubstr("render.device: expected one of cpu, cuda, optix, hip, oneapi, metal, found "
                "'cude' (did you mean 'cuda'?)"));
  EXPECT_THAT(refusal_of_rendering("device: cuda}\ndeterminism: portable\nimage: {gamma: 1"),
              HasSubstr("portable pins kernels of the CPU, and render.device is cuda"));
}

TEST(RenderSection, ARegionIsTheObjectsOrARectangleOfTheImage) {
  EXPECT_EQ(read_rendering("samples: 9")->render.region.box, std::nullopt);
  EXPECT_TRUE(read_rendering("region: objects")->render.region.of_objects);
  EXPECT_FALSE(read_rendering("region: null")->render.region.of_objects);
  const auto config =
      read_rendering("width: 64, height: 48, region: {x: 60, y: 0, width: 4, height: 48}");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->render.region.box, (PixelRect{60, 0, 4, 48}));
  EXPECT_THAT(refusal_of_rendering("region: object"),
              HasSubstr("render.region: expected 'objects', or a rectangle"));
  EXPECT_TRUE(read_rendering("region: {around: objects}")->render.region.of_objects);
  EXPECT_EQ(read_rendering("width: 64, height: 48, region: {x: 10}")->render.region.box,
            (PixelRect{10, 0, 54, 48}))
      << "to the edge";
  EXPECT_THAT(refusal_of_rendering("region: {around: objects, x: 3}"),
              HasSubstr("render.region.x"));
  EXPECT_THAT(refusal_of_rendering("width: 64, region: {x: 60, y: 0, width: 5, height: 8}"),
              HasSubstr("render.region.width"));
}

TEST(RenderSection, PatchesAreOfOneSize) {
  const auto read = [](const std::string& sections) {
    return read_campaign_config("seedframe: 1\ncamera: {distance_m: 1}\n" + sections, "p.yaml");
  };
  EXPECT_EQ(read("")->patches, std::nullopt);
  EXPECT_EQ(read("patches: null")->patches, std::nullopt);
  const auto config = read("patches: {size: 48, least_visible: 0.5, keep_shape: true}");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->patches->size, 48);
  EXPECT_EQ(config->patches->least_visible, 0.5);
  EXPECT_TRUE(config->patches->keep_shape);
  EXPECT_THAT(message_of(read("patches: {size: 0}")), HasSubstr("patches.size"));
  EXPECT_THAT(message_of(read("patches: {least_visible: 0}")),
              HasSubstr("expected a share above 0 and up to 1, found 0"));
  EXPECT_THAT(message_of(read("render: {region: objects}\npatches: {size: 32}")),
              HasSubstr("a patch is a part of the image already"));
}

}  // namespace
}  // namespace seedframe
