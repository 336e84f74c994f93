#include "mesh/collision.h"

#include <gtest/gtest.h>

#include "base/portable_math.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

/// Sides of 2 m about the origin.
const SolidMesh& cube() {
  static const SolidMesh mesh(example_cube());
  return mesh;
}

Eigen::Affine3d pose(const Eigen::Vector3d& position, const Eigen::Vector3d& scale = {1, 1, 1},
                     double turn_z_deg = 0.0) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() =
      Eigen::AngleAxisd(portable::radians(turn_z_deg), Eigen::Vector3d::UnitZ()).matrix() *
      scale.asDiagonal();
  result.translation() = position;
  return result;
}

SolidInstance box(const Eigen::Affine3d& world_from_object) {
  return {&cube(), {Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)}, world_from_object};
}

/// The answer, which must not depend on the order.
bool near(const Eigen::Affine3d& a, const Eigen::Affine3d& b, double gap_m = 0.0) {
  const bool answer = nearer_than(box(a), box(b), gap_m);
  EXPECT_EQ(answer, nearer_than(box(b), box(a), gap_m));
  return answer;
}

TEST(Collision, BoxesThatOverlapTouch) {
  EXPECT_TRUE(near(pose({0, 0, 0}), pose({1.9, 0, 0})));
  EXPECT_TRUE(near(pose({0, 0, 0}), pose({1.9, 1.9, 1.9})));
}

TEST(Collision, BoxesApartDoNot) {
  EXPECT_FALSE(near(pose({0, 0, 0}), pose({2.1, 0, 0})));
  EXPECT_FALSE(near(pose({0, 0, 0}), pose({0, -2.1, 0})));
  EXPECT_FALSE(near(pose({0, 0, 0}), pose({1000, 1000, 0})));
}

TEST(Collision, OneInsideTheOtherTouchesThoughNoSurfacesMeet) {
  EXPECT_TRUE(near(pose({0, 0, 0}), pose({0, 0, 0}, {0.1, 0.1, 0.1})));
  EXPECT_TRUE(near(pose({0, 0, 0}), pose({0.7, -0.6, 0.5}, {0.1, 0.1, 0.1}, 30)));
  EXPECT_TRUE(near(pose({5, 6, 7}, {3, 2, 9}), pose({5, 7, -1}, {0.1, 0.1, 0.1})));
}

TEST(Collision, TheSameBoxTouchesItself) { EXPECT_TRUE(near(pose({1, 2, 3}), pose({1, 2, 3}))); }

TEST(Collision, ItIsTheMeshesThatCountAndNotTheirBoxes) {
  // Turned by 45°, the corner reaches to 1.414 of the 2.3 m; the bounding boxes overlap.
  EXPECT_FALSE(near(pose({0, 0, 0}, {1, 1, 1}, 45), pose({1.8, 1.8, 0}, {1, 1, 1}, 45)));
  EXPECT_TRUE(near(pose({0, 0, 0}, {1, 1, 1}, 45), pose({2.7, 0, 0}, {1, 1, 1}, 45)));
  EXPECT_FALSE(near(pose({0, 0, 0}, {1, 1, 1}, 45), pose({2.9, 0, 0}, {1, 1, 1}, 45)));
}

TEST(Collision, AMarginKeepsThemApart) {
  EXPECT_TRUE(near(pose({0, 0, 0}), pose({2.1, 0, 0}), 0.11));
  EXPECT_FALSE(near(pose({0, 0, 0}), pose({2.1, 0, 0}), 0.09));
  EXPECT_TRUE(near(pose({0, 0, 0}, {1, 1, 1}, 45), pose({2.9, 0, 0}, {1, 1, 1}, 45), 0.08));
  EXPECT_FALSE(near(pose({0, 0, 0}, {1, 1, 1}, 45), pose({2.9, 0, 0}, {1, 1, 1}, 45), 0.06));
}

TEST(Collision, AMarginIsInMetresWhateverTheScale) {
  // Two boxes of 20 mm, 4 mm apart.
  const Eigen::Vector3d small(0.01, 0.01, 0.01);
  EXPECT_TRUE(near(pose({0, 0, 0}, small), pose({0.024, 0, 0}, small), 0.005));
  EXPECT_FALSE(near(pose({0, 0, 0}, small), pose({0.024, 0, 0}, small), 0.003));
  // A large one and a small one.
  EXPECT_TRUE(near(pose({0, 0, 0}, {50, 50, 50}), pose({50.014, 0, 0}, small), 0.005));
  EXPECT_FALSE(near(pose({0, 0, 0}, {50, 50, 50}), pose({50.014, 0, 0}, small), 0.003));
}

TEST(Collision, AMarginIsInMetresAlongEveryAxisOfAStretchedBox) {
  // Plates of 2 m by 2 m by 2 mm: 10 mm apart along the axis that was made small.
  const Eigen::Vector3d plate(1, 1, 0.001);
  EXPECT_TRUE(near(pose({0, 0, 0}, plate), pose({0.3, 0.2, 0.012}, plate), 0.011));
  EXPECT_FALSE(near(pose({0, 0, 0}, plate), pose({0.3, 0.2, 0.012}, plate), 0.009));
  // And along one that was not.
  EXPECT_TRUE(near(pose({0, 0, 0}, plate), pose({2.01, 0.2, 0}, plate), 0.011));
  EXPECT_FALSE(near(pose({0, 0, 0}, plate), pose({2.01, 0.2, 0}, plate), 0.009));
  // Sheared, as in a turned group that is stretched.
  Eigen::Affine3d sheared = pose({0, 0, 0}, {1, 0.1, 1}) * pose({0, 0, 0}, {1, 1, 1}, 45);
  EXPECT_TRUE(near(sheared, pose({0, 1.16, 0}), 0.03));  // it reaches to 0.141
  EXPECT_FALSE(near(sheared, pose({0, 1.16, 0}), 0.01));
}

TEST(Collision, ThinThingsThatCrossTouch) {
  // Two rods like a plus sign: no vertex of one is in or near the other.
  EXPECT_TRUE(near(pose({0, 0, 0}, {5, 0.1, 0.1}), pose({0, 0, 0}, {0.1, 5, 0.1})));
  EXPECT_FALSE(near(pose({0, 0, 0}, {5, 0.1, 0.1}), pose({0, 0, 0.3}, {0.1, 5, 0.1})));
}

TEST(Collision, FarFromTheOriginNothingChanges) {
  EXPECT_TRUE(near(pose({1e6, -1e6, 0}), pose({1e6 + 1.9, -1e6, 0})));
  EXPECT_FALSE(near(pose({1e6, -1e6, 0}), pose({1e6 + 2.1, -1e6, 0})));
}

TEST(Collision, AMeshWithoutTrianglesTouchesNothing) {
  const SolidMesh empty{Mesh{}};
  const SolidInstance nothing{&empty, {}, pose({1, 0, 0})};
  EXPECT_FALSE(nearer_than(nothing, box(pose({0, 0, 0})), 0.0));
  EXPECT_FALSE(nearer_than(box(pose({0, 0, 0})), nothing, 0.5));
}

}  // namespace
}  // namespace seedframe
