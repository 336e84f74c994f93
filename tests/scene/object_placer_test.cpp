// Where objects stand: groups, grids, resting, scales.

#include "scene/object_placer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/placement.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string with_objects(const std::string& objects, const std::string& more = "") {
  return "seedframe: 1\nseed: 2\nobjects:\n" + objects + kCameraAtOrigin + more;
}

void expect_at(const InstanceSpec& instance, const Eigen::Vector3d& expected) {
  // To a nanometre: vertices of meshes are floats.
  EXPECT_LT((place_of(instance) - expected).norm(), 1e-9)
      << instance.name << " is at " << place_of(instance).transpose();
}

std::vector<std::string> names_of(const ExpandedFrame& frame) {
  std::vector<std::string> names;
  for (const InstanceSpec& instance : frame.spec.instances) names.push_back(instance.name);
  return names;
}

TEST(Groups, PlacesAreRelativeToTheParent) {
  const auto frame = first_frame(with_objects(
      "  tray:\n    position: [1, 2, 3]\n    rotation_deg: [0, 0, 90]\n    scale: 2\n    objects:\n"
      "      cup: {asset: cube, category: none, position: [0.5, 0, 0.25], scale: 3}\n"));
  ASSERT_THAT(names_of(frame), ElementsAre("tray/0/cup/0"));
  expect_at(frame.spec.instances[0], {1, 3, 3.5});
  EXPECT_NEAR(frame.spec.instances[0].camera_from_object.linear().col(2).norm(), 6.0, 1e-12);
}

TEST(Groups, TransformsComposeThroughEveryLevel) {
  const auto frame = first_frame(with_objects(R"(
  a:
    position: [1, 0, 0]
    rotation_deg: [10, 20, 30]
    scale: [1, 2, 3]
    objects:
      b:
        asset: cube
        category: none
        position: [0, 1, 0]
        rotation_deg: [40, 50, 60]
        objects:
          c: {asset: cube, category: none, position: [0, 0, 1], rotation_deg: [0, 0, 70], scale: 0.5}
)"));
  const auto pose = [](const Eigen::Vector3d& at, const Eigen::Vector3d& turn,
                       const Eigen::Vector3d& scale) {
    Affine affine = Affine::Identity();
    affine.linear() = rotation_and_scale(turn, scale);
    affine.translation() = at;
    return affine;
  };
  const Affine b =
      pose({1, 0, 0}, {10, 20, 30}, {1, 2, 3}) * pose({0, 1, 0}, {40, 50, 60}, {1, 1, 1});
  const Affine c = b * pose({0, 0, 1}, {0, 0, 70}, {0.5, 0.5, 0.5});
  Affine camera_from_world = Affine::Identity();
  camera_from_world.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  ASSERT_EQ(frame.spec.instances.size(), 2u);
  EXPECT_LT((frame.spec.instances[0].camera_from_object.matrix() - (camera_from_world * b).matrix())
                .norm(),
            1e-12);
  EXPECT_LT((frame.spec.instances[1].camera_from_object.matrix() - (camera_from_world * c).matrix())
                .norm(),
            1e-12);
}

TEST(Groups, IdsFollowTheOrderOfPlacing) {
  const auto frame = first_frame(with_objects(R"(
  stack:
    count: 2
    objects:
      plate: {asset: cube, category: none}
      cup: {asset: sphere, category: none, count: 2}
  last: {asset: cone, category: none}
)"));
  EXPECT_THAT(names_of(frame),
              ElementsAre("stack/0/plate/0", "stack/0/cup/0", "stack/0/cup/1", "stack/1/plate/0",
                          "stack/1/cup/0", "stack/1/cup/1", "last/0"));
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(frame.spec.instances[i].id, static_cast<int>(i) + 1);
  }
}

constexpr const char* kNested = R"(
  shelf:
    count: SHELVES
    variables: {lift: {uniform: [0, 1]}}
    objects:
      book: {asset: cube, category: none, count: BOOKS, variables: {tilt: {uniform: [0, 90]}},
             rotation_deg: [tilt, 0, 0], position: [0, 0, lift]}
      vase: {asset: sphere, category: none, count: 2, scale: {uniform: [1, 2]}}
)";

std::map<std::string, Json> nested_draws(int shelves, int books) {
  std::string text = kNested;
  text.replace(text.find("SHELVES"), 7, std::to_string(shelves));
  text.replace(text.find("BOOKS"), 5, std::to_string(books));
  return draws_by_name(first_frame(with_objects(text)));
}

TEST(Groups, EveryCopyInEveryCopyDrawsForItself) {
  std::set<double> values;
  std::size_t tilts = 0;
  for (const auto& [name, value] : nested_draws(5, 4)) {
    if (name.find("tilt") == std::string::npos) continue;
    ++tilts;
    values.insert(value.get<double>());
  }
  EXPECT_EQ(tilts, 20u);
  EXPECT_EQ(values.size(), 20u);
}

TEST(Groups, DrawsStayWhenOtherCountsChange) {
  const auto before = nested_draws(3, 2);
  for (const auto& after : {nested_draws(3, 9), nested_draws(7, 2), nested_draws(9, 12)}) {
    EXPECT_GT(after.size(), before.size());
    for (const auto& [name, value] : before) EXPECT_EQ(after.at(name), value) << name;
  }
}

TEST(Groups, ChildrenKnowTheVariablesOfTheirParents) {
  const auto frame = first_frame(with_objects(R"(
  rod:
    count: 2
    variables: {size: 0.5 * (copy_index + 1)}
    objects:
      bead: {asset: sphere, category: none, count: copies + 1, position: [size * copy_index, 0, 0]}
)"));
  // The count knows the parent's `copies`, 2; the position the bead's own `copy_index`.
  ASSERT_EQ(frame.spec.instances.size(), 6u);
  expect_at(frame.spec.instances[2], {1, 0, 0});
  expect_at(frame.spec.instances[5], {2, 0, 0});
}

TEST(Groups, AGroupWithoutCopiesHasNothing) {
  EXPECT_TRUE(
      first_frame(with_objects("  none: {count: 0, objects: {o: {asset: cube, category: none}}}\n"))
          .spec.instances.empty());
  EXPECT_TRUE(first_frame(with_objects("  empty: {objects: {}}\n")).spec.instances.empty());
}

TEST(Groups, HaveLimits) {
  EXPECT_THAT(scene_error(with_objects(
                  "  g: {objects: {o: {asset: cube, category: none, count: 1025}}}\n")),
              HasSubstr("a group may hold 1024 copies of an object"));
  EXPECT_THAT(scene_error(with_objects("  o: {asset: cube, category: none, count: 32768}\n")),
              HasSubstr("a count must be from 0 to 32767, found 32768"));
  EXPECT_THAT(
      scene_error(with_objects("  a: {asset: cube, category: none, count: 32767}\n  b: {asset: "
                               "cube, category: none}\n")),
      HasSubstr("a frame can hold at most 32767 objects"));
}

TEST(Grid, CopiesStandInRowsAboutThePosition) {
  const auto frame = first_frame(with_objects(
      "  o: {asset: cube, category: none, position: [10, 0, 0], grid: {counts: [3, 2, 2], "
      "spacing_m: [1, 10, 100]}}\n"));
  ASSERT_EQ(frame.spec.instances.size(), 12u);
  expect_at(frame.spec.instances[0], {9, -5, -50});
  expect_at(frame.spec.instances[1], {10, -5, -50});  // x first
  expect_at(frame.spec.instances[3], {9, 5, -50});    // then y
  expect_at(frame.spec.instances[6], {9, -5, 50});    // then z
  expect_at(frame.spec.instances[11], {11, 5, 50});
}

TEST(Grid, CountsMayVaryAndShortListsMeanOne) {
  const auto frame = first_frame(with_objects(
      "  o: {asset: cube, category: none, grid: {counts: [n], spacing_m: [2, 1, 1]}}\n",
      "variables: {scene: {n: 1 + 1}}\n"));
  ASSERT_EQ(frame.spec.instances.size(), 2u);
  expect_at(frame.spec.instances[0], {-1, 0, 0});
  expect_at(frame.spec.instances[1], {1, 0, 0});
}

TEST(Grid, CopiesDrawForThemselvesAndKnowTheirNumber) {
  const auto frame = first_frame(with_objects(
      "  o: {asset: cube, category: none, grid: {counts: [2, 2]}, position: [0, 0, copy_index], "
      "scale: {uniform: [1, 2]}}\n"));
  ASSERT_EQ(frame.spec.instances.size(), 4u);
  expect_at(frame.spec.instances[3], {0.5, 0.5, 3});
  EXPECT_NE(draws_by_name(frame).at("objects.o.scale/0"),
            draws_by_name(frame).at("objects.o.scale/1"));
}

TEST(Grid, HasBounds) {
  const std::string start = "  o: {asset: cube, category: none, grid: {counts: ";
  EXPECT_TRUE(first_frame(with_objects(start + "[0, 5]}}\n")).spec.instances.empty());
  EXPECT_THAT(scene_error(with_objects(start + "[200, 200, 2]}}\n")),
              HasSubstr("objects.o.grid: a grid may have 32767 copies, this has 80000"));
  EXPECT_THAT(scene_error(with_objects(start + "[32767, 32767, 32767]}}\n")),
              HasSubstr("this has 3518"));
  EXPECT_THAT(scene_error(with_objects(start + "[-1]}}\n")),
              HasSubstr("a count must be from 0 to 32767"));
}

TEST(Scale, OneNumberIsForAllAxesAndAVectorForEach) {
  const auto linear = [](const std::string& scale) -> Eigen::Matrix3d {
    return first_frame(
               with_objects("  o: {asset: cube, category: none, rotation_deg: [0, 0, 90], scale: " +
                            scale + "}\n"))
        .spec.instances.at(0)
        .camera_from_object.linear();
  };
  EXPECT_NEAR(linear("2").determinant(), 8.0, 1e-12);
  const Eigen::Matrix3d three = linear("[2, 3, 4]");
  EXPECT_NEAR(three.col(0).norm(), 2.0, 1e-12);
  EXPECT_NEAR(three.col(1).norm(), 3.0, 1e-12);
  EXPECT_NEAR(three.col(2).norm(), 4.0, 1e-12);
  EXPECT_THAT(scene_error(with_objects("  o: {asset: cube, category: none, scale: [1, 0, 1]}\n")),
              HasSubstr("objects.o.scale[0]: scale must be above 0, found 0"));
}

TEST(Scale, OneDrawnNumberIsOneDrawForAllAxes) {
  const auto frame =
      first_frame(with_objects("  o: {asset: cube, category: none, scale: {uniform: [1, 2]}}\n"));
  const Eigen::Matrix3d linear = frame.spec.instances.at(0).camera_from_object.linear();
  EXPECT_NEAR(linear.col(0).norm(), linear.col(1).norm(), 1e-12);
  EXPECT_NEAR(linear.col(0).norm(), linear.col(2).norm(), 1e-12);
  EXPECT_NEAR(draws_by_name(frame).at("objects.o.scale/0").get<double>(), linear.col(0).norm(),
              1e-12);
}

TEST(Scale, AndPlaceHaveLimits) {
  for (const char* keys : {"scale: 1e20", "scale: 1e-20", "scale: [1e-300, 1, 1]", "scale: 1e308",
                           "position: [1e13, 0, 0]", "position: [1e308, -1e308, 0]"}) {
    const std::string constraint = "constraints: {c: {type: apart, at_least: 1mm}}\n";
    EXPECT_THAT(scene_error(with_objects(
                    std::string("  o: {asset: cube, category: none, count: 2, ") + keys + "}\n",
                    constraint)),
                HasSubstr("objects.o: 'o/0' is too large, too small or too far away"))
        << keys;
  }
  EXPECT_EQ(
      scene_error(with_objects("  o: {asset: cube, category: none, scale: 1e-6, position: [1e9, 0, "
                               "0]}\n")),
      "(no error)");
}

TEST(Resting, FollowsTheCurvatureOfTheGround) {
  const auto frame = first_frame(with_objects(
      "  o: {asset: cube, category: none, rest_on_ground: true, position: [3, 4, 1]}\n",
      "ground: {width_m: 20, depth_m: 20, curvature_per_m: -0.02}\n"));
  // At 5 m from the middle the ground is 0.02 · 25 / 2 lower; half the cube's 50 mm stands on it,
  // upright on the slope.
  const Eigen::Vector3d up = Eigen::Vector3d(0.06, 0.08, 1).normalized();
  ASSERT_EQ(frame.spec.instances.size(), 2u);
  expect_at(frame.spec.instances[1], Eigen::Vector3d(3, 4, 1 - 0.25) + 0.025 * up);
}

TEST(Resting, InAGroupIsOnTheGroupsOwnFloor) {
  const auto frame = first_frame(
      with_objects("  shelf: {position: [3, 4, 7], objects: {o: {asset: cube, category: none, "
                   "rest_on_ground: true}}}\n",
                   "ground: {curvature_per_m: 0.5}\n"));
  expect_at(frame.spec.instances.at(1), {3, 4, 7.025});
}

TEST(HiddenFrom, GoesIntoTheFrameSpec) {
  const auto frame = first_frame(with_objects(
      "  a: {asset: cube, category: none, hidden_from: [camera, shadow]}\n  b: {asset: cube, "
      "category: none}\n"));
  HiddenFrom expected;
  expected.camera = expected.shadow = true;
  EXPECT_EQ(frame.spec.instances.at(0).hidden_from, expected);
  EXPECT_EQ(frame.spec.instances.at(1).hidden_from, HiddenFrom{});
  EXPECT_THAT(scene_error(with_objects("  a: {asset: cube, hidden_from: [camrea]}\n")),
              HasSubstr("unknown kind of ray 'camrea' (did you mean 'camera'?)"));
}

}  // namespace
}  // namespace seedframe
