#include "rays/heap.h"

#include <cmath>

#include <gtest/gtest.h>

#include "rays/height_map.h"

namespace seedframe {
namespace {

Eigen::Affine3d at(double x, double y, double z) {
  return Eigen::Affine3d(Eigen::Translation3d(x, y, z));
}

/// Twelve triangles, from corner to corner.
Mesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back({static_cast<float>((i & 1) != 0 ? high.x() : low.x()),
                              static_cast<float>((i & 2) != 0 ? high.y() : low.y()),
                              static_cast<float>((i & 4) != 0 ? high.z() : low.z())});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  mesh.triangle_slots.assign(mesh.triangles.size(), 0);
  mesh.corner_uvs.resize(3 * mesh.triangles.size());
  mesh.slot_names = {"all"};
  return mesh;
}

class Heap : public ::testing::Test {
 protected:
  Mesh cube_ = box_mesh({-0.5, -0.5, 0.0}, {0.5, 0.5, 1.0});
  Mesh needle_ = box_mesh({-0.01, -0.01, 0.0}, {0.01, 0.01, 3.0});
};

TEST_F(Heap, HeightsAreThoseOfTheMeshFromAboveAndFromBelow) {
  const HeightMap above(cube_, at(2, 0, 5), HeightMap::Side::kAbove);
  const HeightMap below(cube_, at(2, 0, 5), HeightMap::Side::kBelow);
  EXPECT_DOUBLE_EQ(above.at(2.3, -0.4), 6.0);
  EXPECT_DOUBLE_EQ(below.at(2.3, -0.4), 5.0);
  EXPECT_TRUE(std::isnan(above.at(2.6, 0.0)));
  // A ramp from 0 to 1 along x.
  Mesh ramp;
  ramp.positions = {{0, 0, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 0}};
  ramp.triangles = {{0, 1, 2}, {0, 2, 3}};
  const HeightMap slope(ramp, Eigen::Affine3d::Identity(), HeightMap::Side::kAbove);
  for (const double x : {0.1, 0.5, 0.9}) EXPECT_NEAR(slope.at(x, 0.7), x, 1.0 / kHeightSamples);
}

TEST_F(Heap, ACubeOnACubeLiesOnItsTop) {
  const std::vector<double> raised =
      heaped_up({{&cube_, at(0, 0, 0), 0.2}, {&cube_, at(0.3, 0.3, 0), 0.7}});
  EXPECT_DOUBLE_EQ(raised[0], 0.0);
  EXPECT_DOUBLE_EQ(raised[1], 1.0);
}

TEST_F(Heap, TheOrderOfFallingDecidesWhatLiesBelow) {
  const std::vector<double> raised =
      heaped_up({{&cube_, at(0, 0, 0), 0.9}, {&cube_, at(0.3, 0.3, 0), 0.1}});
  EXPECT_DOUBLE_EQ(raised[0], 1.0);
  EXPECT_DOUBLE_EQ(raised[1], 0.0);
}

TEST_F(Heap, WhatStaysIsThereBeforeAll) {
  const std::vector<double> raised =
      heaped_up({{&cube_, at(0, 0, 0), 0.0}, {&cube_, at(0.3, 0.3, 0), std::nullopt}});
  EXPECT_DOUBLE_EQ(raised[0], 1.0);
  EXPECT_DOUBLE_EQ(raised[1], 0.0);
}

TEST_F(Heap, WhatIsBesideOrHighAboveIsNotRaised) {
  EXPECT_EQ(heaped_up({{&cube_, at(0, 0, 0), 0.1}, {&cube_, at(1.1, 0, 0), 0.2}}),
            (std::vector<double>{0.0, 0.0}));
  EXPECT_EQ(heaped_up({{&cube_, at(0, 0, 0), 0.1}, {&cube_, at(0, 0, 4), 0.2}}),
            (std::vector<double>{0.0, 0.0}));
}

TEST_F(Heap, ANeedleIsNotMissedBetweenTheCellsOfWhatFallsOnIt) {
  for (const double x : {0.0, 0.007, 0.013, 0.021}) {
    const std::vector<double> raised =
        heaped_up({{&needle_, at(x, 0.004, 0), 0.1}, {&cube_, at(0, 0, 0), 0.2}});
    EXPECT_DOUBLE_EQ(raised[1], 3.0) << x;
  }
}

TEST_F(Heap, AStackGrowsByItsHeight) {
  std::vector<Heaped> stack;
  for (int i = 0; i < 5; ++i) stack.push_back({&cube_, at(0.1 * i, 0, 0), 0.1 * i});
  const std::vector<double> raised = heaped_up(stack);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(raised[static_cast<std::size_t>(i)], i, 1e-12);
}

TEST_F(Heap, WhatIsSeenEdgeOnHasNoHeight) {
  Mesh wall;
  wall.positions = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}};
  wall.triangles = {{0, 1, 2}};
  EXPECT_EQ(heaped_up({{&wall, at(0, 0, 0), 0.1}, {&cube_, at(0, 0, 0), 0.2}}),
            (std::vector<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace seedframe
