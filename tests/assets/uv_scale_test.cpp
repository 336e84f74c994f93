#include "assets/uv_scale.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/primitives.h"

namespace seedframe {
namespace {

using Uv = std::array<float, 2>;

/// One triangle with these corners.
Mesh triangle(const std::array<std::array<float, 3>, 3>& corners) {
  Mesh mesh;
  mesh.positions.assign(corners.begin(), corners.end());
  mesh.triangles = {{0, 1, 2}};
  mesh.corner_uvs.assign(3, {0.0F, 0.0F});
  mesh.triangle_slots = {0};
  mesh.slot_names = {"slot"};
  return mesh;
}

Mesh projected(const std::array<std::array<float, 3>, 3>& corners) {
  Mesh mesh = triangle(corners);
  project_uvs(mesh);
  return mesh;
}

/// Positive where the picture is not mirrored, seen from outside.
double signed_area(const Mesh& mesh) {
  const Uv *a = &mesh.corner_uvs[0], *b = a + 1, *c = a + 2;
  return (double{(*b)[0]} - (*a)[0]) * (double{(*c)[1]} - (*a)[1]) -
         (double{(*c)[0]} - (*a)[0]) * (double{(*b)[1]} - (*a)[1]);
}

TEST(UvScale, CornersThatAllSayTheSameAreNoCoordinates) {
  Mesh mesh = triangle({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  EXPECT_FALSE(has_uvs(mesh));
  mesh.corner_uvs.assign(3, {0.5F, 0.5F});
  EXPECT_FALSE(has_uvs(mesh));
  mesh.corner_uvs[2] = {0.5F, 0.6F};
  EXPECT_TRUE(has_uvs(mesh));
  EXPECT_FALSE(has_uvs(Mesh()));
}

TEST(UvScale, ProjectedCoordinatesAreMetresAlongTheNearestAxis) {
  const Mesh up = projected({{{1, 2, 5}, {3, 2, 5}, {1, 6, 5.5}}});
  EXPECT_EQ(up.corner_uvs[0], (Uv{1, 2}));
  EXPECT_EQ(up.corner_uvs[1], (Uv{3, 2}));
  EXPECT_EQ(up.corner_uvs[2], (Uv{1, 6}));
  const Mesh front = projected({{{0, 0, 0}, {2, 0, 0}, {0, 0, 3}}});  // faces −y
  EXPECT_EQ(front.corner_uvs[1], (Uv{2, 0}));
  EXPECT_EQ(front.corner_uvs[2], (Uv{0, 3}));
}

TEST(UvScale, NoSideOfABoxShowsAMirroredPicture) {
  Mesh box = triangle({{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}});
  const std::array<std::array<float, 3>, 8> c = {
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};
  const std::array<std::array<int, 3>, 6> sides = {
      {{0, 2, 1}, {4, 5, 6}, {0, 1, 4}, {3, 2, 7}, {2, 0, 6}, {1, 3, 5}}};
  for (const auto& [i, j, k] : sides) {
    const Mesh side = projected({c[static_cast<std::size_t>(i)], c[static_cast<std::size_t>(j)],
                                 c[static_cast<std::size_t>(k)]});
    EXPECT_NEAR(std::abs(signed_area(side)), 1.0, 1e-6) << i << j << k;
    // Seen from below, y points the other way on the page; everywhere else nothing is turned over.
    EXPECT_GT(signed_area(side), 0.0) << i << j << k;
  }
}

TEST(UvScale, AUnitCoversTheRootOfTheRatioOfAreas) {
  Mesh mesh = triangle({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}});
  mesh.corner_uvs = {{0, 0}, {2, 0}, {0, 2}};
  EXPECT_EQ(metres_per_uv(mesh), 2.0);
  mesh.corner_uvs = {{0, 0}, {-8, 0}, {0, 8}};  // mirrored
  EXPECT_EQ(metres_per_uv(mesh), 0.5);
  mesh.corner_uvs.assign(3, {0.0F, 0.0F});
  EXPECT_EQ(metres_per_uv(mesh), 1.0);
  EXPECT_EQ(metres_per_uv(Mesh()), 1.0);
}

}  // namespace
}  // namespace seedframe
