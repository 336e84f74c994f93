#include "mesh/mesh.h"

#include <Eigen/Geometry>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/philox.h"
#include "mesh/primitives.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

void expect_refused(const Mesh& mesh, const std::string& reason) {
  const Status status = check_mesh(mesh, "part.obj");
  ASSERT_FALSE(status.has_value()) << reason;
  EXPECT_EQ(status.error().kind, ErrorKind::kInput);
  EXPECT_THAT(status.error().message, HasSubstr("part.obj"));
  EXPECT_THAT(status.error().message, HasSubstr(reason));
}

TEST(CheckMesh, AcceptsAClosedMeshAndAnOpenOne) {
  EXPECT_TRUE(check_mesh(example_cube(), "cube"));
  EXPECT_TRUE(check_mesh(example_patch(3), "patch"));
}

TEST(CheckMesh, RefusesWhatCannotBeRendered) {
  expect_refused(Mesh{}, "empty");

  Mesh mesh = example_cube();
  mesh.triangles.clear();
  expect_refused(mesh, "empty");

  mesh = example_cube();
  mesh.positions[3][1] = std::numeric_limits<float>::quiet_NaN();
  expect_refused(mesh, "vertex 3");

  mesh = example_cube();
  mesh.positions[7][2] = std::numeric_limits<float>::infinity();
  expect_refused(mesh, "vertex 7");

  mesh = example_cube();
  mesh.corner_uvs[4][0] = std::numeric_limits<float>::quiet_NaN();
  expect_refused(mesh, "triangle 1 has a UV");

  mesh = example_cube();
  mesh.triangles[2][0] = 8;
  expect_refused(mesh, "triangle 2 names vertex 8, but there are 8");

  mesh = example_cube();
  for (auto& position : mesh.positions) position = {1.0f, 2.0f, 3.0f};
  expect_refused(mesh, "zero area");
}

TEST(CheckMesh, RefusesArraysOfWrongLengths) {
  Mesh mesh = example_cube();
  mesh.corner_uvs.pop_back();
  expect_refused(mesh, "36 corner UVs, found 35");

  mesh = example_cube();
  mesh.triangle_slots.pop_back();
  expect_refused(mesh, "found 11");

  mesh = example_cube();
  mesh.slot_names.clear();
  expect_refused(mesh, "at least one material slot");

  mesh = example_cube();
  mesh.slot_names.pop_back();
  expect_refused(mesh, "names material slot 1, but there are 1");

  mesh = example_cube();
  mesh.smooth_angle_rad = -0.1;
  expect_refused(mesh, "smoothing angle");
}

TEST(BoundingBox, IsTight) {
  const BoundingBox box = bounding_box(example_patch(8));
  EXPECT_EQ(box.low.x(), 0.0);
  EXPECT_EQ(box.high.x(), static_cast<double>(0.3f));
  EXPECT_EQ(box.size().y(), static_cast<double>(0.2f));
  EXPECT_EQ(bounding_box(Mesh{}).size(), Eigen::Vector3d::Zero());
}

TEST(SurfaceArea, OfACubeIsSixSides) { EXPECT_DOUBLE_EQ(surface_area(example_cube()), 24.0); }

TEST(LowestZ, FollowsTheLinearMap) {
  const Mesh cube = example_cube();
  EXPECT_EQ(lowest_z(cube, Eigen::Matrix3d::Identity()), -1.0);
  EXPECT_EQ(lowest_z(cube, 2.5 * Eigen::Matrix3d::Identity()), -2.5);
  const Eigen::Matrix3d on_an_edge =
      Eigen::AngleAxisd(portable::kPi / 4.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NEAR(lowest_z(cube, on_an_edge), -std::sqrt(2.0), 1e-12);
}

TEST(LowestPoint, AgreesWithEveryVertexToTheLastBit) {
  const Mesh patch = example_patch(60);
  const LowestPoint fast(patch);
  const PhiloxStream stream(1, "lowest-point");
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    Eigen::Matrix3d linear;
    for (std::uint32_t i = 0; i < 9; ++i) {
      linear(i / 3, i % 3) = 4.0 * stream.uniform({.frame = trial, .copy = i}) - 2.0;
    }
    if (trial % 5 == 0) linear(2, trial % 3) = 0.0;  // whole rows of vertices at one height
    ASSERT_EQ(fast.z(linear), lowest_z(patch, linear)) << "trial " << trial;
  }
}

TEST(LowestPoint, OfNothingIsInfinitelyHigh) {
  EXPECT_EQ(LowestPoint().z(Eigen::Matrix3d::Identity()), std::numeric_limits<double>::infinity());
}

TEST(GroundPlane, FacesUpWithUvsInMetres) {
  const Mesh plane = ground_surface(6.0, 4.0, 0.0);
  ASSERT_TRUE(check_mesh(plane, "ground"));
  EXPECT_DOUBLE_EQ(surface_area(plane), 24.0);
  EXPECT_EQ(bounding_box(plane).low, Eigen::Vector3d(-3.0, -2.0, 0.0));
  EXPECT_EQ(bounding_box(plane).high, Eigen::Vector3d(3.0, 2.0, 0.0));
  for (std::size_t t = 0; t < plane.triangles.size(); ++t) {
    const auto& [a, b, c] = plane.triangles[t];
    const auto& p = plane.positions;
    const float up =
        (p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) - (p[b][1] - p[a][1]) * (p[c][0] - p[a][0]);
    EXPECT_GT(up, 0.0f);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto& position = p[plane.triangles[t][corner]];
      EXPECT_EQ(plane.corner_uvs[3 * t + corner][0], position[0]);
      EXPECT_EQ(plane.corner_uvs[3 * t + corner][1], position[1]);
    }
  }
}

}  // namespace
}  // namespace seedframe
