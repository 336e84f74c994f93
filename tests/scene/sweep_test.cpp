// Sweeps: every combination of some values, a scene for each.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kSweep = R"(seedframe: 1
seed: 3
scenes: 2
frames_per_scene: 2
variables:
  campaign: {hue: {uniform: [0, 360]}}
  scene: {tall: {uniform: [1, 2]}}
  frame: {turn: {uniform: [0, 360]}}
sweep:
  values:
    size: [1, 2]
    yaw: [0, 90, 180]
objects:
  box: {asset: cube, category: none, scale: size, rotation_deg: [0, 0, yaw],
        position: [{normal: [0, 1]}, 0, tall]}
camera: {distance_m: 5, azimuth_deg: turn}
lights: {lamp: {power: {uniform: [1, 2]}}}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The scale of the first instance, whatever its rotation.
double scale_of(const ExpandedFrame& frame) {
  return frame.spec.instances.at(0).camera_from_object.linear().col(0).norm();
}

TEST(Sweep, EverySceneIsOneCombination) {
  const auto frames = all_frames(kSweep);
  ASSERT_EQ(frames.size(), 2u * 6u * 2u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].scene, static_cast<std::int64_t>(i / 2));
    EXPECT_EQ(frames[i].view, static_cast<std::int64_t>(i % 2));
  }
}

TEST(Sweep, TheLastAxisIsTheFastest) {
  const auto frames = all_frames(
      "seedframe: 1\nscenes: 2\nvariables: {scene: {code: 10 * a + b}}\n"
      "sweep: {values: {a: [1, 2], b: [5, 6, 7]}}\ncamera: {distance_m: 1}\n");
  std::vector<double> codes;
  for (const ExpandedFrame& frame : frames) codes.push_back(frame.graph.at("code").get<double>());
  EXPECT_THAT(codes, ElementsAre(15, 16, 17, 25, 26, 27, 15, 16, 17, 25, 26, 27));
}

TEST(Sweep, AxesFollowTheFileAndNotTheAlphabet) {
  const auto frames = all_frames(
      "seedframe: 1\nvariables: {scene: {code: 10 * z + a}}\n"
      "sweep: {values: {z: [1, 2], a: [5, 6]}}\ncamera: {distance_m: 1}\n");
  std::vector<double> codes;
  for (const ExpandedFrame& frame : frames) codes.push_back(frame.graph.at("code").get<double>());
  EXPECT_THAT(codes, ElementsAre(15, 16, 25, 26));
}

TEST(Sweep, AllElseIsHeldWithinOneProduct) {
  const auto frames = all_frames(kSweep);
  const auto first = draws_by_name(frames[0]);
  EXPECT_EQ(first.size(), 5u);
  for (std::size_t scene = 1; scene < 6; ++scene) {
    const ExpandedFrame& frame = frames[2 * scene];
    EXPECT_EQ(draws_by_name(frame), first) << scene;
    EXPECT_EQ(frame.spec.render.seed, frames[0].spec.render.seed);
    EXPECT_NE(frame.id, frames[0].id);
  }
  EXPECT_NEAR(scale_of(frames[0]), 1.0, 1e-12);
  EXPECT_NEAR(scale_of(frames[2 * 3]), 2.0, 1e-12);
}

TEST(Sweep, EveryProductDrawsAnew) {
  const auto frames = all_frames(kSweep);
  const auto before = draws_by_name(frames[0]);
  const auto after = draws_by_name(frames[12]);
  EXPECT_EQ(before.at("variables.campaign.hue"), after.at("variables.campaign.hue"));
  for (const char* name : {"variables.scene.tall", "variables.frame.turn", "lights.lamp.power/0",
                           "objects.box.position[0]/0"}) {
    EXPECT_NE(before.at(name), after.at(name)) << name;
  }
  EXPECT_NE(frames[0].spec.render.seed, frames[12].spec.render.seed);
}

TEST(Sweep, FramesOfASceneDifferThoughDrawsAreHeld) {
  const auto frames = all_frames(kSweep);
  EXPECT_NE(draws_by_name(frames[0]).at("variables.frame.turn"),
            draws_by_name(frames[1]).at("variables.frame.turn"));
  EXPECT_EQ(draws_by_name(frames[1]).at("variables.frame.turn"),
            draws_by_name(frames[3]).at("variables.frame.turn"));
}

TEST(Sweep, WithoutHoldDrawsEverySceneDrawsAnew) {
  const auto frames = all_frames(replaced(kSweep, "sweep:\n", "sweep:\n  hold_draws: false\n"));
  EXPECT_NE(draws_by_name(frames[0]).at("variables.scene.tall"),
            draws_by_name(frames[2]).at("variables.scene.tall"));
  EXPECT_NE(frames[0].spec.render.seed, frames[2].spec.render.seed);
}

TEST(Sweep, HeldDrawsAreThoseOfTheSameConfigWithoutASweep) {
  const auto swept = all_frames(kSweep);
  const auto plain = all_frames(
      replaced(replaced(kSweep, "sweep:\n  values:\n    size: [1, 2]\n    yaw: [0, 90, 180]\n", ""),
               "campaign: {", "campaign: {size: 1, yaw: 0, "));
  ASSERT_EQ(plain.size(), 4u);
  EXPECT_EQ(plain[0].id, swept[0].id);
  EXPECT_EQ(plain[1].id, swept[1].id);
  EXPECT_EQ(plain[2].id, swept[12].id);
}

TEST(Sweep, AMappingSetsSeveralVariablesAtOnce) {
  const auto frames = all_frames(
      "seedframe: 1\nvariables: {scene: {area: w * h}}\n"
      "sweep: {values: {format: [{w: 2, h: 3}, {h: 5, w: 4}]}}\ncamera: {distance_m: 1}\n");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].graph.at("area"), 6.0);
  EXPECT_EQ(frames[1].graph.at("area"), 20.0);
}

TEST(Sweep, NamesCanBeSweptAndUsedInNamesAndFormulas) {
  const auto frames = all_frames(R"(seedframe: 1
sweep: {values: {tint: [red, blue]}}
variables: {scene: {height: "tint == 'red' ? 1 : 3"}}
objects: {box: {asset: cube, category: none, material: "${tint}_paint"}}
materials:
  red_paint: {base_color: [1, 0, 0]}
  blue_paint: {base_color: [0, 0, 1]}
camera: {distance_m: height}
)");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].spec.materials[0].base_color, (Rgb{1, 0, 0}));
  EXPECT_EQ(frames[1].spec.materials[0].base_color, (Rgb{0, 0, 1}));
  EXPECT_NEAR(frames[1].spec.instances[0].camera_from_object.translation().norm(), 3.0, 1e-9);
}

TEST(Sweep, CampaignVariablesDoNotKnowIt) {
  EXPECT_THAT(scene_error(replaced(kSweep, "hue: {uniform: [0, 360]}", "hue: size")),
              HasSubstr("'size' is neither a number"));
}

TEST(Sweep, ANameThatIsTakenIsRefused) {
  EXPECT_THAT(scene_error(replaced(kSweep, "size: [1, 2]", "hue: [1, 2]")),
              HasSubstr("sweep.values.hue: the name 'hue' is taken"));
  EXPECT_THAT(scene_error(replaced(kSweep, "    yaw: [0", "    tall: [0")),
              HasSubstr("variables.scene.tall: the name 'tall' is taken"));
}

TEST(Sweep, BuiltInNamesCannotBeVariables) {
  for (const std::string name : {"pi", "scene_index", "frame_index", "copy_index", "copies"}) {
    EXPECT_THAT(scene_error(replaced(kSweep, "    size: [1, 2]",
                                     "    size: [1, 2]\n    " + name + ": [1, 2]")),
                HasSubstr("scene.yaml:12:" + std::to_string(7 + name.size()) + ": sweep.values." +
                          name + ": '" + name + "' is built in"));
    for (const std::string level : {"campaign", "scene", "frame"}) {
      EXPECT_THAT(scene_error(replaced(kSweep, "  " + level + ": {",
                                       "  " + level + ": {" + name + ": 1, ")),
                  HasSubstr("variables." + level + "." + name + ": '" + name + "' is built in"));
    }
    EXPECT_THAT(
        scene_error(replaced(kSweep, "asset: cube", "variables: {" + name + ": 1}, asset: cube")),
        HasSubstr("objects.box.variables." + name + ": '" + name + "' is built in"));
  }
}

}  // namespace
}  // namespace seedframe
