// Where objects come to stand: free places, and the ground under them.

#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "draws/evaluation_context.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

std::string crowded(const std::string& more) {
  // Three gears whose footprints are 92 mm wide fit into the strip, but not after all places of
  // two.
  return "seedframe: 1\nscenes: 12\nframes_per_scene: 2\ncategories: [gear]\n"
         "objects: {o: {asset: gear, count: 3, scatter: {x: [0, 0.26], y: [0, 0]}" +
         more + "}}\ncamera: {distance_m: 1}\n";
}

TEST(Layout, AScatterThatFoundNoPlaceIsLaidOutAnewAlikeInAllFramesOfAScene) {
  auto expander = expander_of(crowded(""));
  ASSERT_TRUE(expander) << expander.error().message;
  for (std::int64_t frame = 0; frame < expander->frame_count(); ++frame) {
    const auto expanded = expander->expand(frame, {.draws = true});
    ASSERT_TRUE(expanded) << expanded.error().message;
    EXPECT_EQ(expanded->attempts, 1u);
    EXPECT_EQ(expanded->spec.instances.size(), 3u);
    EXPECT_EQ(std::count_if(expanded->draws.begin(), expanded->draws.end(),
                            [](const Draw& draw) { return draw.name == "objects.o.scatter.x/2"; }),
              1);
    if (frame % 2 == 0) continue;
    const auto other_view = expander->expand(frame - 1);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(expanded->spec.instances[i].camera_from_object.matrix(),
                other_view->spec.instances[i].camera_from_object.matrix());
    }
  }
}

TEST(Layout, NoTwoLayoutsShareDraws) {
  std::set<std::uint32_t> firsts;
  for (std::uint32_t i = 0; i < kMostLayouts; ++i) firsts.insert(first_attempt_of(i));
  ASSERT_EQ(firsts.size(), kMostLayouts);
  std::uint32_t before = *firsts.begin();
  EXPECT_EQ(before, 0U);
  for (auto first = std::next(firsts.begin()); first != firsts.end(); before = *first++) {
    EXPECT_GE(*first - before, kMostAttemptsOfLayout);
  }
  EXPECT_LE(before, 0U - kMostAttemptsOfLayout);
  EXPECT_EQ(first_attempt_of(31), 31U << 27U) << "as they were when there were 32";
}

// One of the demo's scenes, of which one in thousands is so full.
TEST(Layout, AFullSceneIsLaidOutUntilAllHavePlaces) {
  const std::filesystem::path file = kHome / "configs" / "parts.yaml";
  constexpr std::int64_t kScene = 18186, kFramesPerScene = 5;
  std::string text = *read_file(file);
  text.replace(text.find("scenes: 6"), 9, "scenes: " + std::to_string(kScene + 1));
  const auto expander = expander_of(text, file);
  ASSERT_TRUE(expander) << expander.error().message;
  EXPECT_GT(frame_of(*expander, kScene * kFramesPerScene).spec.instances.size(), 15U);
}

TEST(Layout, AFramesOwnScatterThatFoundNoPlaceIsAnotherAttemptAtTheFrame) {
  auto expander = expander_of(crowded(", redraw: frame"));
  ASSERT_TRUE(expander) << expander.error().message;
  std::uint32_t most = 0;
  for (std::int64_t frame = 0; frame < expander->frame_count(); ++frame) {
    const auto expanded = expander->expand(frame);
    ASSERT_TRUE(expanded) << expanded.error().message;
    most = std::max(most, expanded->attempts);
  }
  EXPECT_GT(most, 1u);
}

TEST(Layout, AGroundGivesWayToFacesInItsPlane) {
  const auto height = [](const std::string& object) {
    auto expander = expander_of("seedframe: 1\ncategories: [cube]\nground: {}\nobjects: {o: {" +
                                object + "}}\ncamera: {position: [0, 0, 4], target: [0, 0, 0]}\n");
    EXPECT_TRUE(expander) << expander.error().message;
    const auto frame = expander->expand(0);
    EXPECT_TRUE(frame) << frame.error().message;
    return frame->spec.instances.at(0).camera_from_object.translation().z() + 4.0;
  };
  const std::string cube = "asset: cube, category: cube, ";
  EXPECT_EQ(height(cube + "rest_on_ground: true"), 0.0);
  EXPECT_EQ(height(cube + "position: [0, 0, 0]"), 0.0) << "cut by the ground, and no face in it";
  EXPECT_EQ(height(cube + "position: [0, 0, 1]"), 0.0);
  const double half = 0.025;  // metres: the cube's
  EXPECT_NEAR(height(cube + fmt::format("position: [0, 0, {}]", -half)), -1e-4, 1e-12);
  EXPECT_NEAR(height(cube + "rest_on_ground: true, scale: [1, 1, 1e-7]"), -1e-4, 1e-12);
}

std::vector<Eigen::Matrix3d> rotations(const std::string& object, const std::string& more = "") {
  auto expander = expander_of(
      "seedframe: 1\nscenes: 400\ncategories: [cube]\nobjects: {o: {asset: cube, "
      "category: cube, " +
      object + "}}\n" + more + "camera: {position: [0, 0, 4], target: [0, 0, 0]}\n");
  EXPECT_TRUE(expander) << expander.error().message;
  std::vector<Eigen::Matrix3d> all;
  for (std::int64_t frame = 0; expander && frame < expander->frame_count(); ++frame) {
    const auto expanded = expander->expand(frame, {.id = false});
    EXPECT_TRUE(expanded) << expanded.error().message;
    all.emplace_back(expanded->spec.instances.at(0).camera_from_object.linear());
  }
  return all;
}

TEST(Layout, ARandomRotationIsAnyOneAlikeLikely) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  double trace = 0.0;  // its mean over all rotations is 0, its mean square 1
  double square = 0.0;
  const auto all = rotations("rotation: random");
  for (const Eigen::Matrix3d& rotation : all) {
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-12);
    mean += rotation / static_cast<double>(all.size());
    trace += rotation.trace() / static_cast<double>(all.size());
    square += rotation.trace() * rotation.trace() / static_cast<double>(all.size());
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.12) << "four standard errors of a mean of 1/3";
  EXPECT_NEAR(trace, 0.0, 0.2);
  EXPECT_NEAR(square, 1.0, 0.25);
}

TEST(Layout, AQuaternionTurnsAsItsAnglesDo) {
  const auto angles = rotations("rotation_deg: [0, 0, 90]");
  const auto quaternion = rotations("rotation: {quaternion: [2, 0, 0, 2]}");
  EXPECT_LT((angles.at(0) - quaternion.at(0)).norm(), 1e-12);
  const auto tilted = rotations("rotation: {quaternion: [0.9238795325112867, q, 0, 0]}",
                                "variables: {scene: {q: 0.3826834323650898}}\n");
  EXPECT_LT((rotations("rotation_deg: [45, 0, 0]").at(0) - tilted.at(0)).norm(), 1e-12);
  EXPECT_THAT(expander_of("seedframe: 1\nobjects: {o: {asset: cube, category: none, rotation: "
                          "{quaternion: [0, 0, 0, 0]}}}\ncamera: {distance_m: 1}\n")
                  ->expand(0)
                  .error()
                  .message,
              ::testing::HasSubstr("a quaternion needs a length above 0"));
}

TEST(Layout, ACategoryForEachAssetGoesWithIt) {
  const auto object = [](const std::string& category) {
    return "seedframe: 1\nscenes: 20\ncategories: [round, square]\nobjects: {o: {asset: {choice: "
           "[cube, gear]}, "
           "category: " +
           category + "}}\ncamera: {distance_m: 1}\n";
  };
  const auto expander = expander_of(object("{cube: square, gear: round}"));
  ASSERT_TRUE(expander) << expander.error().message;
  std::set<std::string> seen;
  for (std::int64_t frame = 0; frame < expander->frame_count(); ++frame) {
    const InstanceSpec instance = expander->expand(frame)->spec.instances.at(0);
    EXPECT_EQ(instance.category, instance.asset == "cube" ? 2 : 1);
    seen.insert(instance.asset);
  }
  EXPECT_EQ(seen.size(), 2u);
  const auto offered = expander->offered_assets();
  ASSERT_TRUE(offered);
  EXPECT_EQ(offered->at(0).categories, std::set<std::string>{"square"});
  const auto error = [&](const std::string& category) {
    const auto refused = expander_of(object(category));
    return refused ? std::string() : refused.error().message;
  };
  EXPECT_THAT(error("{cube: square}"),
              ::testing::HasSubstr("category says nothing of the asset 'gear'"));
  EXPECT_THAT(error("{cube: square, gear: ruond}"), ::testing::HasSubstr("did you mean 'round'?"));
  EXPECT_THAT(error("{cube: square, gear: round, gaer: round}"),
              ::testing::HasSubstr("the object's asset is never 'gaer' (did you mean 'gear'?)"));
}

TEST(Layout, ObjectsOfAGroupShareItsMaterial) {
  const auto room = [](const std::string& walls) {
    return "seedframe: 1\ncategories: [cube]\nobjects: {room: {count: 2, material: paint, objects: "
           "{"
           "a: {asset: cube, category: cube, material: " +
           walls +
           "}, "
           "b: {asset: cube, category: cube, material: " +
           walls +
           ", position: [1, 0, 0]}, "
           "c: {asset: cube, category: cube, material: steel}}}}\n"
           "materials: {paint: {base_color: {hsv: [{uniform: [0, 360]}, 0.5, 0.5]}}}\n"
           "camera: {distance_m: 1}\n";
  };
  const auto expander = expander_of(room("parent"));
  ASSERT_TRUE(expander) << expander.error().message;
  const auto frame = expander->expand(0, {.draws = true});
  ASSERT_TRUE(frame) << frame.error().message;
  const auto& instances = frame->spec.instances;
  ASSERT_EQ(instances.size(), 6u);
  EXPECT_EQ(instances[0].materials, instances[1].materials);
  EXPECT_EQ(instances[3].materials, instances[4].materials);
  EXPECT_NE(instances[0].materials, instances[3].materials) << "each copy has its own";
  EXPECT_NE(instances[0].materials, instances[2].materials);
  EXPECT_EQ(std::count_if(frame->draws.begin(), frame->draws.end(),
                          [](const Draw& draw) {
                            return draw.name.starts_with("objects.room.material.paint.base_color");
                          }),
            2);
  // Of what a group's material may show, too: images are looked at before a worker sees them.
  const auto textured = expander_of(
      "seedframe: 1\nobjects: {g: {material: Concrete01, objects: {a: {asset: cube, category: "
      "none, "
      "material: parent}}}}\ncamera: {distance_m: 1}\n");
  ASSERT_TRUE(textured) << textured.error().message;
  EXPECT_FALSE(textured->offered_images().empty());
  const auto apart = expander_of(room("paint"))->expand(0);
  EXPECT_NE(apart->spec.instances[0].materials, apart->spec.instances[1].materials);
  EXPECT_THAT(
      expander_of("seedframe: 1\nobjects: {a: {asset: cube, category: none, material: parent}}\n"
                  "camera: {distance_m: 1}\n")
          .error()
          .message,
      ::testing::HasSubstr("material: parent, but 'a' is in no other object"));
  EXPECT_THAT(expander_of("seedframe: 1\nobjects: {g: {objects: {a: {asset: cube, category: none, "
                          "material: parent}}}}\n"
                          "camera: {distance_m: 1}\n")
                  .error()
                  .message,
              ::testing::HasSubstr("material: parent, but 'g' has no material"));
}

TEST(Layout, WhatRestsStablyLiesOnItsSixSides) {
  std::map<int, int> sides;  // of a cube with chamfers: which of its axes points up
  for (const Eigen::Matrix3d& rotation : rotations("rest: stable")) {
    const Eigen::Vector3d up = rotation.row(2);
    Eigen::Index axis = 0;
    EXPECT_NEAR(up.cwiseAbs().maxCoeff(&axis), 1.0, 1e-3);
    ++sides[static_cast<int>(axis) * 2 + (up[axis] > 0 ? 1 : 0)];
  }
  EXPECT_EQ(sides.size(), 6u);
  for (const auto& [side, count] : sides) EXPECT_NEAR(count, 400 / 6, 34) << side;
}

}  // namespace
}  // namespace seedframe
