#include "rays/projected_bounds.h"

#include <gtest/gtest.h>

#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

constexpr PixelCamera kBoundsCamera{160, 120, {100.0, 100.0}, {79.5, 59.5}, 0.1, 1000.0};

/// The cube from (-1, -1, -1) to (1, 1, 1), moved.
std::optional<PixelBounds> bounds_of_cube(double x, double y, double z) {
  return projected_bounds(example_cube(), Eigen::Affine3d(Eigen::Translation3d(x, y, z)),
                          kBoundsCamera);
}

TEST(ProjectedBounds, AreThoseOfTheNearestCorners) {
  const auto bounds = bounds_of_cube(0, 0, -5);  // its front is at 4 m
  ASSERT_TRUE(bounds);
  EXPECT_DOUBLE_EQ(bounds->left, 79.5 - 25);
  EXPECT_DOUBLE_EQ(bounds->right, 79.5 + 25);
  EXPECT_DOUBLE_EQ(bounds->top, 59.5 - 25);
  EXPECT_DOUBLE_EQ(bounds->bottom, 59.5 + 25);
}

TEST(ProjectedBounds, MayBeBeyondTheImage) {
  const auto beside = bounds_of_cube(20, 0, -5);
  ASSERT_TRUE(beside);
  EXPECT_GT(beside->left, 160);
  EXPECT_FALSE(clipped_to_image(*beside, kBoundsCamera));
  const auto partly = clipped_to_image(*bounds_of_cube(4, 0, -5), kBoundsCamera);
  ASSERT_TRUE(partly);
  EXPECT_DOUBLE_EQ(partly->left, 79.5 + 50);  // by the back of its left side, at 6 m
  EXPECT_DOUBLE_EQ(partly->right, 159.5);
}

TEST(ProjectedBounds, HoldWhatReachesBehindTheCamera) {
  const auto around = bounds_of_cube(0, 0, 0);
  ASSERT_TRUE(around);
  const auto seen = clipped_to_image(*around, kBoundsCamera);
  ASSERT_TRUE(seen);
  EXPECT_DOUBLE_EQ(seen->left, -0.5);
  EXPECT_DOUBLE_EQ(seen->bottom, 119.5);
  EXPECT_FALSE(bounds_of_cube(0, 0, 5)) << "behind it altogether";
}

}  // namespace
}  // namespace seedframe
