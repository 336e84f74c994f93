// Frames that are drawn again because a constraint does not hold: what is drawn anew, what stays.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"
#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr int kRejectionScenes = 40;
constexpr int kViews = 5;

// Two things that must be 1 m apart, and draws of every other kind around them.
constexpr const char* kScene = R"(seedframe: 1
seed: 12
scenes: 40
frames_per_scene: 5
variables:
  campaign: {c: {uniform: [0, 1]}}
  scene: {s: {uniform: [0, 1]}}
  frame: {f: {uniform: [0, 1]}}
objects:
  fixed: {asset: cube, category: none, position: [0, 0, {uniform: [0, 0.1]}]}
  moving: {asset: cube, category: none, redraw: frame, position: [{uniform: [0, 2]}, 0, 0]}
lights: {lamp: {power: {uniform: [1, 2]}}}
camera: {distance_m: 5, azimuth_deg: {uniform: [0, 360]}}
)";
constexpr const char* kApart = "constraints: {apart: {type: distance, at_least: 1}}\n";

const std::vector<ExpandedFrame>& free_frames() {
  static const std::vector<ExpandedFrame> frames = all_frames(kScene);
  return frames;
}
const std::vector<ExpandedFrame>& bound_frames() {
  static const std::vector<ExpandedFrame> frames = all_frames(std::string(kScene) + kApart);
  return frames;
}

double x_of_moving(const ExpandedFrame& frame) {
  return draws_by_name(frame).at("objects.moving.position[0]/0").get<double>();
}

TEST(Rejection, EveryFrameMeetsTheConstraint) {
  ASSERT_EQ(bound_frames().size(), static_cast<std::size_t>(kRejectionScenes * kViews));
  for (const ExpandedFrame& frame : bound_frames()) {
    const auto& all = frame.spec.instances;
    EXPECT_GE(
        (all.at(0).camera_from_object.translation() - all.at(1).camera_from_object.translation())
            .norm(),
        1.0);
  }
}

TEST(Rejection, AFrameThatHoldsAtOnceIsAsItWouldBeWithout) {
  int kept = 0;
  for (std::size_t i = 0; i < bound_frames().size(); ++i) {
    if (bound_frames()[i].attempts > 1) continue;
    ++kept;
    EXPECT_EQ(bound_frames()[i].id, free_frames()[i].id);
  }
  EXPECT_GT(kept, 60);
  EXPECT_LT(kept, 140);
}

TEST(Rejection, RedrawsAllOfTheFrameLevelAndNothingElse) {
  for (std::size_t i = 0; i < bound_frames().size(); ++i) {
    if (bound_frames()[i].attempts == 1) continue;
    const auto before = draws_by_name(free_frames()[i]);
    const auto after = draws_by_name(bound_frames()[i]);
    ASSERT_EQ(before.size(), after.size());
    for (const auto& [name, value] : before) {
      const bool of_frame = name == "variables.frame.f" || name == "camera.azimuth_deg" ||
                            name == "objects.moving.position[0]/0";
      EXPECT_EQ(value == after.at(name), !of_frame) << name;
    }
    EXPECT_NE(bound_frames()[i].spec.render.seed, free_frames()[i].spec.render.seed);
  }
}

TEST(Rejection, IsTheConditionalDistribution) {
  // x is uniform over [0, 2] given that the distance to (0, 0, z) is at least 1; z is below 0.1,
  // which moves the bound by less than 0.005.
  std::vector<double> x;
  for (const ExpandedFrame& frame : bound_frames()) x.push_back(x_of_moving(frame));
  EXPECT_GT(kolmogorov_p(x, [](double v) { return std::clamp((v - 0.9975) / 1.0025, 0.0, 1.0); }),
            kLeastP);
}

TEST(Rejection, AttemptsAreCountedAndAreGeometric) {
  std::vector<double> counts(4, 0.0);
  for (const ExpandedFrame& frame : bound_frames()) {
    counts[std::min<std::size_t>(frame.attempts, 4) - 1] += 1.0;
  }
  const double n = kRejectionScenes * kViews;
  EXPECT_GT(chi_squared_p(counts, {n / 2, n / 4, n / 8, n / 8}), kLeastP);
}

TEST(Rejection, TalliesSayHowOftenAConstraintWasMet) {
  auto expander =
      expander_of(std::string(kScene) +
                  "constraints:\n  apart: {type: distance, at_least: 1}\n  seen: {type: "
                  "in_view, at_least: 0}\n");
  EXPECT_EQ(expander->constraint_names(), (std::vector<std::string>{"apart", "seen"}));
  std::int64_t most_attempts = 0;
  for (std::int64_t i = 0; i < 50; ++i) {
    const ExpandedFrame frame = frame_of(*expander, i);
    ASSERT_EQ(frame.constraints.size(), 2u);
    EXPECT_EQ(frame.constraints[0].checked, frame.attempts);
    EXPECT_EQ(frame.constraints[0].met, 1);
    EXPECT_EQ(frame.constraints[1].checked, 1);  // the cheaper one is looked at first
    EXPECT_EQ(frame.constraints[1].met, 1);
    most_attempts = std::max<std::int64_t>(most_attempts, frame.attempts);
  }
  EXPECT_GT(most_attempts, 1);
}

TEST(Rejection, AFrameDoesNotDependOnWhichWereExpandedBefore) {
  auto expander = expander_of(std::string(kScene) + kApart);
  for (const std::int64_t frame : {77, 3, 140, 3, 0}) {
    EXPECT_EQ(frame_of(*expander, frame).id, bound_frames()[static_cast<std::size_t>(frame)].id);
  }
}

TEST(Rejection, RecordsOnlyTheDrawsThatCount) {
  for (const ExpandedFrame& frame : bound_frames()) {
    std::size_t moves = 0;
    for (const Draw& draw : frame.draws) moves += draw.name == "objects.moving.position[0]/0";
    EXPECT_EQ(moves, 1u);
  }
}

TEST(Rejection, RedrawsScatteredCopies) {
  const auto frames = all_frames(R"(seedframe: 1
seed: 3
frames_per_scene: 20
objects:
  o: {asset: cube, category: none, count: 3, redraw: frame, scatter: {x: [-1, 1], y: [-1, 1]}}
constraints: {spread: {type: distance, at_least: 0.8}}
camera: {distance_m: 5}
)");
  std::uint32_t most = 0;
  for (const ExpandedFrame& frame : frames) {
    most = std::max(most, frame.attempts);
    for (const InstanceSpec& a : frame.spec.instances) {
      for (const InstanceSpec& b : frame.spec.instances) {
        if (a.id == b.id) continue;
        EXPECT_GE((a.camera_from_object.translation() - b.camera_from_object.translation()).norm(),
                  0.8 - 1e-9);
      }
    }
  }
  EXPECT_GT(most, 1u);
}

TEST(Rejection, RedrawsWhatIsSobolFromAnotherScramble) {
  const std::string text = R"(seedframe: 1
frames_per_scene: 64
variables: {frame: {x: {sobol: [0, {uniform: [0, 1]}]}, y: {uniform: [0, 1]}}}
objects:
  a: {asset: cube, category: none}
  b: {asset: cube, category: none, position: [y, 0, 0]}
camera: {distance_m: 5}
)";
  const auto before = all_frames(text);
  const auto after = all_frames(text + "constraints: {apart: {type: distance, at_least: 0.5}}\n");
  int redrawn = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (after[i].attempts == 1) {
      EXPECT_EQ(before[i].graph, after[i].graph);
    } else {
      ++redrawn;
      EXPECT_NE(before[i].graph.at("x"), after[i].graph.at("x"));
    }
  }
  EXPECT_GT(redrawn, 10);
}

TEST(Rejection, WhatCannotHoldIsAnErrorThatNamesTheConstraint) {
  EXPECT_THAT(scene_error(std::string(kScene) +
                          "max_attempts: 7\nconstraints:\n  far: {type: distance, at_least: 50}\n"),
              HasSubstr("scene.yaml:16:8: constraints.far: no draw of this frame met all "
                        "constraints in 7 attempts; in the last one 'far' was not met"));
}

TEST(Rejection, WhatDoesNotVaryByFrameCannotBeMended) {
  EXPECT_THAT(
      scene_error("seedframe: 1\nscenes: 20\nobjects:\n  a: {asset: cube, category: none}\n"
                  "  b: {asset: cube, category: none, position: [{uniform: [0, 2]}, 0, 0]}\n"
                  "constraints: {apart: {type: distance, at_least: 1}}\n"
                  "camera: {distance_m: 5}\n"),
      HasSubstr("only frame-level draws are made again"));
}

TEST(Rejection, AFaultInARedrawnFrameIsReportedAsSuch) {
  EXPECT_THAT(scene_error(std::string(kScene) +
                          "constraints: {far: {type: distance, at_least: 1 / (f - f)}}\n"),
              HasSubstr("constraints.far.at_least: the value is"));
}

// By rays in C++ that know nothing of the checker: cubes stand square to the camera, so what the
// nearer one hides is a rectangle.
TEST(Rejection, VisibleFractionsAreThoseOfABruteForceReference) {
  const std::string text = R"(seedframe: 1
seed: 5
frames_per_scene: 300
render: {width: 400, height: 400}
variables: {frame: {x: {uniform: [-0.06, 0.06]}, z: {uniform: [-0.06, 0.06]}}}
objects:
  front: {asset: cube, category: none, position: [x, 1, z], scale: [1, 0.001, 1]}
  back: {asset: cube, category: none, position: [0, 1.001, 0], scale: [1, 0.001, 1]}
camera: {position: [0, 0, 0], target: [0, 1, 0], fov_deg: 8}
constraints: {seen: {type: visible, objects: [back], at_least: 0.7}}
)";
  int rejected = 0;
  auto expander = expander_of(text);
  for (std::int64_t i = 0; i < 300; ++i) {
    const auto frame = frame_of(*expander, i);
    const double x = std::fabs(frame.graph.at("x").get<double>());
    const double z = std::fabs(frame.graph.at("z").get<double>());
    const double hidden = std::max(0.0, 0.05 - x) * std::max(0.0, 0.05 - z) / (0.05 * 0.05);
    EXPECT_GT(1.0 - hidden, 0.7 - 0.03);
    rejected += frame.attempts > 1 ? 1 : 0;
  }
  // A frame is rejected when more than 0.3 is hidden, which is (1 − 0.3 + 0.3 ln 0.3) of the part
  // of the square where anything is hidden, 25/36.
  const double expected = 25.0 / 36.0 * (1.0 - 0.3 + 0.3 * std::log(0.3));
  EXPECT_NEAR(rejected / 300.0, expected, 0.08);
}

}  // namespace
}  // namespace seedframe
