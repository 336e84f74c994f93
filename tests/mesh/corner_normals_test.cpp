#include "mesh/corner_normals.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

using Normals = std::vector<std::array<float, 3>>;

Normals normals_of(const Mesh& mesh, double angle) {
  return corner_normals(mesh.positions, mesh.triangles, angle);
}

void expect_near(const std::array<float, 3>& found, double x, double y, double z) {
  EXPECT_NEAR(found[0], x, 1e-6);
  EXPECT_NEAR(found[1], y, 1e-6);
  EXPECT_NEAR(found[2], z, 1e-6);
}

TEST(CornerNormals, ACubeWithSharpEdgesIsFlat) {
  const Mesh cube = example_cube();
  for (const double angle : {0.0, 0.5, 1.57}) {
    const Normals normals = normals_of(cube, angle);
    ASSERT_EQ(normals.size(), 36U);
    for (int i = 0; i < 6; ++i) expect_near(normals[static_cast<std::size_t>(i)], 0, -1, 0);
    for (int i = 24; i < 30; ++i) expect_near(normals[static_cast<std::size_t>(i)], 0, 0, 1);
  }
}

TEST(CornerNormals, ACubeWithoutSharpEdgesHasNormalsAlongItsDiagonals) {
  // Weighted by angles, the two triangles of a face count as one; by number or area they would not.
  const Mesh cube = example_cube();
  const Normals normals = normals_of(cube, 3.2);
  const double third = 1.0 / std::sqrt(3.0);
  for (std::size_t c = 0; c < normals.size(); ++c) {
    const auto& corner = cube.positions[cube.triangles[c / 3][c % 3]];
    expect_near(normals[c], third * corner[0], third * corner[1], third * corner[2]);
  }
}

TEST(CornerNormals, TheAngleDecidesEdgeByEdge) {
  // A roof of three planes: 30 degrees at the first ridge, 60 at the second.
  Mesh mesh;
  const double a = portable::kPi / 6.0;
  std::vector<std::array<double, 2>> profile = {{0, 0}, {1, 0}};
  profile.push_back({1 + std::cos(a), -std::sin(a)});
  profile.push_back({profile[2][0] + std::cos(3 * a), profile[2][1] - std::sin(3 * a)});
  for (const auto& [x, z] : profile) {
    for (const float y : {0.0F, 1.0F}) {
      mesh.positions.push_back({static_cast<float>(x), y, static_cast<float>(z)});
    }
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  const Normals normals = normals_of(mesh, portable::kPi / 4.0);
  // Corner 1 of triangle 0 is on the first ridge: half way between the two planes.
  expect_near(normals[1], std::sin(0.5 * a), 0, std::cos(0.5 * a));
  // Corner 1 of triangle 2 is on the second ridge, which is sharp.
  expect_near(normals[7], std::sin(a), 0, std::cos(a));
  expect_near(normals[12], std::sin(3 * a), 0, std::cos(3 * a));
}

TEST(CornerNormals, AnEdgeOfThreeTrianglesIsSharp) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 1, 4}};
  const Normals normals = normals_of(mesh, 3.2);
  expect_near(normals[0], 0, 0, 1);
  expect_near(normals[6], 1, 0, 0);
}

TEST(CornerNormals, ATriangleWithoutAreaHasNoNormal) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  for (const auto& normal : normals_of(mesh, 0.5)) expect_near(normal, 0, 0, 0);
}

}  // namespace
}  // namespace seedframe
