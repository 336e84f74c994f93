#include "scene/ground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/sha256.h"
#include "mesh/mesh_buffer.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

std::string with_ground(const std::string& ground, const std::string& more = "") {
  return "seedframe: 1\nground: {" + ground + "}\n" + kCameraAtOrigin + more;
}

TEST(Ground, IsAnInstanceWithoutALabel) {
  const auto frame = first_frame(with_ground(""));
  ASSERT_EQ(frame.spec.instances.size(), 1u);
  EXPECT_EQ(frame.spec.instances[0].name, "ground");
  EXPECT_EQ(frame.spec.instances[0].id, 0);
  EXPECT_EQ(frame.spec.instances[0].category, 0);
  EXPECT_EQ(frame.spec.instances[0].mesh,
            sha256_hex(*frame.meshes.at(frame.spec.instances[0].mesh)));
}

TEST(Ground, HasItsSizeAndCurvature) {
  const auto frame = first_frame(with_ground("width_m: 4, depth_m: 6m, curvature_per_m: 0.5"));
  const auto mesh = mesh_from_buffer(*frame.meshes.at(frame.spec.instances[0].mesh), "ground");
  ASSERT_TRUE(mesh);
  const BoundingBox box = bounding_box(*mesh);
  EXPECT_LT((box.low - Eigen::Vector3d(-2, -3, 0)).norm(), 1e-6);
  EXPECT_LT((box.high - Eigen::Vector3d(2, 3, 0.5 * 13 / 2)).norm(), 1e-6);
}

TEST(Ground, ADrawnSizeIsAnotherMeshInEveryScene) {
  const auto frames = all_frames(with_ground("width_m: {uniform: [1, 2]}", "scenes: 2\n"));
  EXPECT_NE(frames.at(0).spec.instances.at(0).mesh, frames.at(1).spec.instances.at(0).mesh);
  const auto same = all_frames(with_ground("width_m: 2", "scenes: 2\n"));
  EXPECT_EQ(same.at(0).spec.instances.at(0).mesh, same.at(1).spec.instances.at(0).mesh);
}

TEST(Ground, HasBounds) {
  EXPECT_THAT(scene_error(with_ground("width_m: 0")),
              HasSubstr("the ground's width_m must be above 0"));
  EXPECT_THAT(scene_error(with_ground("depth_m: -1")),
              HasSubstr("the ground's depth_m must be above 0"));
  for (const char* huge :
       {"width_m: 1e300", "depth_m: 1e39", "curvature_per_m: 1e300", "curvature_per_m: -1e300"}) {
    EXPECT_THAT(scene_error(with_ground(huge)), HasSubstr("ground: the ground is too large"))
        << huge;
  }
  for (const char* tiny : {"width_m: 1e-300", "depth_m: 1e-320"}) {
    EXPECT_THAT(scene_error(with_ground(tiny)), HasSubstr("scene.yaml:2:9: ground: the ground"))
        << tiny;
  }
}

}  // namespace
}  // namespace seedframe
