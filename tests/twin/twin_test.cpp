#include "twin/twin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/twin/scenes.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
constexpr auto kAsked = TwinTracer::Passes::kAsked;
constexpr auto kIdsOnly = TwinTracer::Passes::kIdsOnly;

const CubeBuffer& cube() {
  static const CubeBuffer shared;
  return shared;
}

/// Cube 7 stands before cube 3 and hides its left half; the floor has no id.
FrameSpec two_cubes() {
  FrameSpec spec = empty_spec();
  spec.instances = {cube_at(cube(), 3, 0, 0, -11), cube_at(cube(), 7, -1, 0, -6, 0.55),
                    cube_at(cube(), 0, 0, -31, -20, 30)};
  return spec;
}

TEST(Twin, EveryPixelHasTheIdOfTheInstanceThatIsSeenThere) {
  const auto twin = TwinTracer().trace(two_cubes(), cube().buffers, kIdsOnly);
  ASSERT_TRUE(twin) << twin.error().message;
  EXPECT_EQ(twin->instance_ids.at(59, 85), 3);
  EXPECT_EQ(twin->instance_ids.at(59, 70), 7) << "the nearer one";
  EXPECT_EQ(twin->instance_ids.at(110, 80), 0) << "the floor has no id";
  EXPECT_EQ(twin->instance_ids.at(5, 5), 0) << "nothing";
  EXPECT_FALSE(twin->depth);
  EXPECT_FALSE(twin->normal);
}

TEST(Twin, DepthIsPlanarAndNormalsPointToTheCamera) {
  FrameSpec spec = two_cubes();
  spec.render.depth = spec.render.normal = true;
  const auto twin = TwinTracer().trace(spec, cube().buffers, kAsked);
  ASSERT_TRUE(twin) << twin.error().message;
  EXPECT_FLOAT_EQ(twin->depth->at(59, 85), 10.0F);
  EXPECT_FLOAT_EQ(twin->depth->at(68, 88), 10.0F) << "not the distance along the ray";
  EXPECT_FLOAT_EQ(twin->depth->at(5, 5), kNoDepth);
  EXPECT_NEAR(twin->normal->at(59, 85, 2), 1.0, 1e-6);
  EXPECT_NEAR(twin->normal->at(110, 80, 1), 1.0, 1e-6) << "the floor's faces up";
  for (int c = 0; c < 3; ++c) EXPECT_EQ(twin->normal->at(5, 5, c), 0.0F);
}

TEST(Twin, VerticesFarFromTheirMeshsOriginCostNothing) {
  constexpr float kFar = 65536.0F;  // a cube's corners stay float32 numbers there
  Mesh mesh = example_cube();
  for (auto& position : mesh.positions) position[0] += kFar;
  const auto bytes = std::make_shared<const std::string>(mesh_buffer(mesh));
  MeshBuffers buffers = cube().buffers;
  buffers["far"] = bytes;
  FrameSpec spec = two_cubes();
  spec.render.depth = spec.render.normal = true;
  for (InstanceSpec& instance : spec.instances) {
    instance.camera_from_object.rotate(
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, 0.5, 0.2).normalized()));
  }
  FrameSpec moved = spec;
  for (InstanceSpec& instance : moved.instances) {
    instance.mesh = "far";
    instance.camera_from_object.translate(Eigen::Vector3d(-kFar, 0, 0));
  }
  TwinTracer tracer;
  const auto near = tracer.trace(spec, buffers, kAsked);
  const auto far = tracer.trace(moved, buffers, kAsked);
  ASSERT_TRUE(near && far);
  EXPECT_EQ(far->instance_ids.values, near->instance_ids.values);
  for (std::size_t i = 0; i < near->depth->values.size(); ++i) {
    ASSERT_FLOAT_EQ(far->depth->values[i], near->depth->values[i]) << i;
  }
  EXPECT_EQ(far->object_box(0).low, Eigen::Vector3d(kFar - 1.0, -1, -1));
}

TEST(Twin, KnowsWhatAPixelGrazes) {
  FrameSpec spec = empty_spec();
  // Its right edge is 5 thousandths of a pixel to the right of the centre of column 90.
  spec.instances = {cube_at(cube(), 3, 0.0505, 0, -11)};
  const auto twin = TwinTracer().trace(spec, cube().buffers, kIdsOnly);
  ASSERT_TRUE(twin);
  EXPECT_EQ(twin->instance_ids.at(59, 90), 3);
  EXPECT_TRUE(twin->grazes(59, 90, 0));
  EXPECT_TRUE(twin->grazes(59, 90, 3));
  EXPECT_FALSE(twin->grazes(59, 90, 7));
  EXPECT_FALSE(twin->grazes(59, 89, 0));
  EXPECT_FALSE(twin->grazes(59, 91, 3));
}

TEST(Twin, KnowsWhichSurfacesCoincide) {
  FrameSpec spec = empty_spec();
  // Fronts at one depth, 1 µm and 1 mm behind it; the last one stands beside them.
  spec.instances = {cube_at(cube(), 3, 0, 0, -11), cube_at(cube(), 7, 0.5, 0, -11.000001),
                    cube_at(cube(), 9, 0.5, 0, -11.001), cube_at(cube(), 11, -2.5, 0, -11)};
  const auto twin = TwinTracer().trace(spec, cube().buffers, kIdsOnly);
  ASSERT_TRUE(twin);
  const int middle = spec.render.width / 2;
  const int row = spec.render.height / 2;
  EXPECT_EQ(twin->first_hits(row, middle), (std::vector<int>{0, 1}));
  EXPECT_TRUE(twin->coincides(row, middle, 3));
  EXPECT_TRUE(twin->coincides(row, middle, 7));
  EXPECT_FALSE(twin->coincides(row, middle, 9));
  EXPECT_FALSE(twin->coincides(row, middle, 11));
  EXPECT_TRUE(twin->first_hits(0, 0).empty());
}

TEST(Twin, FromTheInsideNormalsPointToTheCameraToo) {
  FrameSpec spec = empty_spec();
  spec.render.normal = true;
  spec.instances = {cube_at(cube(), 1, 0, 0, 0, 4)};
  const auto twin = TwinTracer().trace(spec, cube().buffers, kAsked);
  ASSERT_TRUE(twin);
  EXPECT_EQ(twin->instance_ids.at(60, 80), 1);
  EXPECT_NEAR(twin->normal->at(60, 80, 2), 1.0, 1e-6);
}

TEST(Twin, NormalsOfUnequallyScaledInstancesStandOnTheirSurfaces) {
  FrameSpec spec = empty_spec();
  spec.render.normal = true;
  InstanceSpec slab = cube_at(cube(), 1, 0, 0, -6);
  // Turned by 45 degrees and then flattened: the normal is not the turned one any more.
  slab.camera_from_object = Affine::Identity();
  slab.camera_from_object.translate(Eigen::Vector3d(0, 0, -6));
  slab.camera_from_object.scale(Eigen::Vector3d(1, 1, 0.25));
  slab.camera_from_object.rotate(Eigen::AngleAxisd(0.25 * portable::kPi, Eigen::Vector3d::UnitY()));
  spec.instances = {slab};
  const auto twin = TwinTracer().trace(spec, cube().buffers, kAsked);
  ASSERT_TRUE(twin);
  // A side of the cube runs along (1, 0, 0.25) or (1, 0, -0.25): normals (±0.25, 0, 1) / 1.03.
  EXPECT_NEAR(std::abs(twin->normal->at(60, 90, 0)), 0.25 / std::hypot(1.0, 0.25), 1e-5);
  EXPECT_NEAR(twin->normal->at(60, 90, 2), 1.0 / std::hypot(1.0, 0.25), 1e-5);
}

TEST(Twin, TheNumberOfThreadsChangesNothing) {
  FrameSpec spec = two_cubes();
  spec.render.depth = spec.render.normal = true;
  const auto one = TwinTracer(1).trace(spec, cube().buffers, kAsked);
  const auto three = TwinTracer(3).trace(spec, cube().buffers, kAsked);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->instance_ids.values, three->instance_ids.values);
  EXPECT_EQ(one->depth->values, three->depth->values);
  EXPECT_EQ(one->normal->values, three->normal->values);
}

TEST(Twin, SilhouettesSeeThroughWhatStandsBefore) {
  const FrameSpec spec = two_cubes();
  const auto twin = TwinTracer().trace(spec, cube().buffers, kIdsOnly);
  ASSERT_TRUE(twin);
  const std::vector<Silhouette> silhouettes = twin->silhouettes(twin->instance_ids);
  ASSERT_EQ(silhouettes.size(), 3U);
  // The front face at 10 m covers 20 × 20 pixels, all of it: 69.5 to 89.5.
  EXPECT_EQ(silhouettes[0].box, (PixelRect{70, 50, 20, 20}));
  EXPECT_EQ(silhouettes[0].area_px, 400);
  EXPECT_EQ(silhouettes[0].in_image_px, 400);
  EXPECT_TRUE(silhouettes[2].box.empty()) << "no id, no silhouette";
}

TEST(Twin, SilhouettesHoldEveryPixelThatIsSaidToBeVisible) {
  const FrameSpec spec = two_cubes();
  const auto twin = TwinTracer().trace(spec, cube().buffers, kIdsOnly);
  ASSERT_TRUE(twin);
  Image<std::uint16_t> rendered = twin->instance_ids;
  rendered.at(0, 159) = 3;  // far from where it is
  const std::vector<Silhouette> silhouettes = twin->silhouettes(rendered);
  EXPECT_EQ(silhouettes[0].area_px, 401);
  EXPECT_EQ(silhouettes[0].box, (PixelRect{70, 0, 90, 70}));
}

TEST(Twin, WhatTheCameraDoesNotSeeIsNotThere) {
  FrameSpec spec = two_cubes();
  spec.instances[1].hidden_from.camera = true;
  const auto twin = TwinTracer().trace(spec, cube().buffers, kIdsOnly);
  ASSERT_TRUE(twin);
  EXPECT_EQ(twin->instance_ids.at(59, 72), 3);
  EXPECT_TRUE(twin->silhouettes(twin->instance_ids)[1].box.empty());
}

TEST(Twin, TreesAreKeptForTheNextFrame) {
  TwinTracer tracer;
  ASSERT_TRUE(tracer.trace(two_cubes(), cube().buffers, kIdsOnly));
  EXPECT_TRUE(tracer.trace(two_cubes(), {}, kIdsOnly)) << "no buffer is read again";
}

TEST(Twin, AMissingOrDamagedMeshIsNamed) {
  const auto missing = TwinTracer().trace(two_cubes(), {}, kIdsOnly);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr(cube().sha256.substr(0, 12)));
  const MeshBuffers damaged = {{cube().sha256, std::make_shared<const std::string>("SFMESH01")}};
  TwinTracer tracer;
  const auto result = tracer.trace(two_cubes(), damaged, kIdsOnly);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kCorrupt);
  EXPECT_TRUE(tracer.trace(two_cubes(), cube().buffers, kIdsOnly)) << "nothing of it stays";
}

}  // namespace
}  // namespace seedframe
