#include "mesh/stable_faces.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/primitives.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

/// Sides in metres, about the origin.
Mesh box(float x, float y, float z) {
  Mesh mesh = example_cube();
  for (auto& position : mesh.positions) {
    position[0] *= x / 2;
    position[1] *= y / 2;
    position[2] *= z / 2;
  }
  return mesh;
}

/// Points all over the sides of a cube of 2 m, each up to 20 µm off.
Mesh rough_cube() {
  Mesh mesh = example_cube();
  for (int side = 0; side < 6; ++side) {
    for (int i = 1; i < 12; ++i) {
      for (int j = 1; j < 12; ++j) {
        std::array<float, 3> at{};
        const auto axis = static_cast<std::size_t>(side / 2);
        at[axis] = (side % 2 == 0 ? -1.0F : 1.0F) *
                   (1.0F + 1e-6F * static_cast<float>((i * 7 + j * 13) % 20));
        at[(axis + 1) % 3] = static_cast<float>(i) / 6.0F - 1.0F;
        at[(axis + 2) % 3] = static_cast<float>(j) / 6.0F - 1.0F;
        mesh.positions.push_back(at);
      }
    }
  }
  return mesh;
}

double sum_of(const std::vector<StableFace>& faces) {
  double sum = 0.0;
  for (const StableFace& face : faces) sum += face.probability;
  return sum;
}

/// Of a rectangle with half sides a and b, seen from d above its middle.
double solid_angle(double a, double b, double d) {
  return 4.0 * std::asin(a * b / std::sqrt((a * a + d * d) * (b * b + d * d)));
}

TEST(StableFaces, ABoxStandsOnEachOfItsFacesAsOftenAsItsSolidAngleSays) {
  const auto faces = stable_faces(box(2, 4, 6), {1, 1, 1});
  ASSERT_TRUE(faces) << faces.error().message;
  ASSERT_EQ(faces->size(), 6u);
  EXPECT_NEAR(sum_of(*faces), 1.0, 1e-12);
  const double whole = 4.0 * std::numbers::pi;
  EXPECT_NEAR((*faces)[0].probability, solid_angle(2, 3, 1) / whole, 1e-12);
  EXPECT_NEAR(std::abs((*faces)[0].normal.x()), 1.0, 1e-12);
  EXPECT_NEAR((*faces)[5].probability, solid_angle(1, 2, 3) / whole, 1e-12);
  EXPECT_NEAR(std::abs((*faces)[5].normal.z()), 1.0, 1e-12);
}

TEST(StableFaces, AScaleIsOfTheObject) {
  const auto scaled = stable_faces(box(2, 2, 2), {1, 2, 3});
  const auto made = stable_faces(box(2, 4, 6), {1, 1, 1});
  ASSERT_TRUE(scaled && made);
  ASSERT_EQ(scaled->size(), made->size());
  for (std::size_t i = 0; i < made->size(); ++i) {
    EXPECT_NEAR((*scaled)[i].probability, (*made)[i].probability, 1e-12);
  }
}

TEST(StableFaces, WhatLeansTooFarTipsOver) {
  // A column of 1 × 1 × 4, sheared by 3 along x: its middle is 1 beyond the edge of its foot.
  Mesh mesh = box(1, 1, 4);
  for (auto& position : mesh.positions) position[0] += 0.75F * (position[2] + 2.0F);
  const auto faces = stable_faces(mesh, {1, 1, 1});
  ASSERT_TRUE(faces) << faces.error().message;
  EXPECT_NEAR(sum_of(*faces), 1.0, 1e-12);
  EXPECT_EQ(faces->size(), 4u) << "its foot and its top are none to stand on";
  for (const StableFace& face : *faces) EXPECT_LT(std::abs(face.normal.z()), 0.9);
}

TEST(StableFaces, ARoughFaceIsOne) {
  const auto faces = stable_faces(rough_cube(), {1, 1, 1});
  ASSERT_TRUE(faces) << faces.error().message;
  EXPECT_EQ(faces->size(), 6u);
  for (const StableFace& face : *faces) EXPECT_NEAR(face.probability, 1.0 / 6.0, 1e-3);
}

TEST(StableFaces, StandingTurnsTheFaceDownAndIsARotation) {
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0),
        Eigen::Vector3d(0.6, 0, 0.8), Eigen::Vector3d(-0.36, 0.48, -0.8)}) {
    const Eigen::Matrix3d turn = standing_on({normal, 1.0});
    EXPECT_LT((turn * normal - Eigen::Vector3d(0, 0, -1)).norm(), 1e-12) << normal.transpose();
    EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(turn.determinant(), 1.0, 1e-12);
  }
}

TEST(StableFaces, AFlatMeshHasNone) {
  EXPECT_THAT(stable_faces(ground_surface(1, 1, 0), {1, 1, 1}).error().message,
              ::testing::HasSubstr("flat"));
}

}  // namespace
}  // namespace seedframe
