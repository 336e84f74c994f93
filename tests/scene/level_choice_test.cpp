#include "scene/level_choice.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

/// 0.2 m wide; level 0 is 1 µm off, level 1 0.1 mm, level 2 1 mm.
Asset box_of_three_levels() {
  Asset asset;
  asset.box = {Eigen::Vector3d::Constant(-0.1), Eigen::Vector3d::Constant(0.1)};
  asset.levels = {{1000, 1e-6, ""}, {300, 1e-4, ""}, {100, 1e-3, ""}};
  return asset;
}

CameraSpec camera(double focal_px) {
  CameraSpec spec;
  spec.focal_px = {focal_px, focal_px};
  spec.clip_start_m = 0.01;
  spec.clip_end_m = 1000.0;
  return spec;
}

std::size_t level_at(double depth_m, double focal_px, double scale = 1.0, double aside_m = 0.0) {
  Affine map = Affine::Identity();
  map.translate(Eigen::Vector3d(aside_m, 0, -depth_m));
  map.scale(scale);
  return level_of_detail(box_of_three_levels(), map, camera(focal_px));
}

TEST(LevelChoice, EachLevelFromTheDepthOnAtWhichItsErrorIsATwentiethOfAPixel) {
  // 0.101 mm at 500 px of focal length is 0.05 px at 1.01 m; the nearest point is 0.1 m nearer.
  EXPECT_EQ(level_at(0.5, 500), 0U);
  EXPECT_EQ(level_at(1.05, 500), 0U);
  EXPECT_EQ(level_at(1.2, 500), 1U);
  EXPECT_EQ(level_at(9.9, 500), 1U);
  EXPECT_EQ(level_at(10.3, 500), 2U);
}

TEST(LevelChoice, ScaleAndFocalLengthCountLikeDepth) {
  EXPECT_EQ(level_at(10.3, 500, 2.0), 1U);
  EXPECT_EQ(level_at(10.3, 1000), 1U);
  EXPECT_EQ(level_at(5.3, 250), 2U);
}

TEST(LevelChoice, TheLongestAxisCounts) {
  Affine map = Affine::Identity();
  map.translate(Eigen::Vector3d(0, 0, -10.3));
  map.scale(Eigen::Vector3d(0.1, 2.0, 0.1));
  EXPECT_EQ(level_of_detail(box_of_three_levels(), map, camera(500)), 1U);
}

TEST(LevelChoice, ToTheSideAPixelIsNearer) { EXPECT_EQ(level_at(10.3, 500, 1.0, 20.0), 1U); }

TEST(LevelChoice, AtTheNearPlaneAndBehindItTheMeshItselfIsTaken) {
  EXPECT_EQ(level_at(0.1, 500), 0U);
  EXPECT_EQ(level_at(-50, 500), 0U);
}

TEST(LevelChoice, AnAssetWithoutLevelsHasNoChoice) {
  Asset asset = box_of_three_levels();
  asset.levels.resize(1);
  Affine map = Affine::Identity();
  map.translate(Eigen::Vector3d(0, 0, -900));
  EXPECT_EQ(level_of_detail(asset, map, camera(500)), 0U);
}

}  // namespace
}  // namespace seedframe
