#include "mesh/mesh_distance.h"

#include <gtest/gtest.h>

#include "tests/mesh/example_meshes.h"
#include "tests/mesh/mesh_distance_reference.h"

namespace seedframe {
namespace {

Mesh shifted(Mesh mesh, float z) {
  for (auto& p : mesh.positions) p[2] += z;
  return mesh;
}

TEST(MeshDistance, OfShiftedAndEqualSurfacesIsKnown) {
  const Mesh cube = example_cube();
  const auto same = hausdorff_distance(cube, cube, 1e-4, "cubes");
  ASSERT_TRUE(same);
  EXPECT_EQ(same->lower_m, 0.0);
  EXPECT_LE(same->upper_m, 1e-4);
  const auto apart = hausdorff_distance(cube, shifted(cube, 0.25f), 1e-3, "cubes");
  ASSERT_TRUE(apart);
  EXPECT_LE(apart->lower_m, 0.25);
  EXPECT_GE(apart->upper_m, 0.25);
  EXPECT_LE(apart->upper_m - apart->lower_m, 1e-3 + 1e-12);
}

TEST(MeshDistance, LooksBothWaysAndInsideTriangles) {
  // The fine wavy patch against two triangles: the greatest distance is within a triangle of the
  // coarse one, at no vertex of it.
  const Mesh fine = example_patch(20);
  const Mesh coarse = example_patch(1);
  const auto there = hausdorff_distance(fine, coarse, 1e-4, "patches");
  const auto back = hausdorff_distance(coarse, fine, 1e-4, "patches");
  ASSERT_TRUE(there && back);
  EXPECT_GT(there->lower_m, 0.01);
  EXPECT_NEAR(there->upper_m, back->upper_m, 2e-4);
}

TEST(MeshDistance, AgreesWithCgal) {
  for (const std::uint32_t n : {2u, 3u, 5u, 9u}) {
    const Mesh fine = example_patch(17);
    const Mesh coarse = shifted(example_patch(n), 0.001f);
    const auto ours = hausdorff_distance(fine, coarse, 2e-4, "patches");
    const auto reference = reference_hausdorff_distance(fine, coarse, 1e-4, "patches");
    ASSERT_TRUE(ours) << ours.error().message;
    ASSERT_TRUE(reference) << reference.error().message;
    EXPECT_LE(ours->lower_m, reference->upper_m) << n;
    EXPECT_GE(ours->upper_m, reference->lower_m) << n;
  }
}

// A flat square of n × n cells whose inner vertices are moved within the plane.
Mesh flat_grid(std::uint32_t n, float move) {
  Mesh mesh = example_patch(n);
  for (auto& p : mesh.positions) {
    const bool inner = p[0] > 0.0f && p[0] < 0.299f && p[1] > 0.0f && p[1] < 0.199f;
    p = {p[0] + (inner ? move : 0.0f), p[1] + (inner ? 0.7f * move : 0.0f), 0.0f};
  }
  return mesh;
}

// A flat disc of n triangles around its centre, which is moved within the plane.
Mesh fan(std::uint32_t n, float move) {
  Mesh mesh;
  mesh.positions.push_back({move, 0.7f * move, 0.0f});
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2.0 * M_PI * i / n;
    mesh.positions.push_back({0.1f * static_cast<float>(portable::cos(angle)),
                              0.1f * static_cast<float>(portable::sin(angle)), 0.0f});
    mesh.triangles.push_back({0, i + 1, (i + 1) % n + 1});
  }
  mesh.corner_uvs.resize(std::size_t{3} * n);
  mesh.triangle_slots.resize(n);
  mesh.slot_names = {"disc"};
  return mesh;
}

TEST(MeshDistance, OfFlatSurfacesIsQuicklyToldWhateverTheirTriangles) {
  // As compression moves vertices: halving triangles until each is within one of the other mesh
  // would take a hundred million steps.
  for (const auto& [a, b] : {std::pair(flat_grid(5, 0.0f), flat_grid(5, 4e-6f)),
                             std::pair(flat_grid(40, 0.0f), flat_grid(40, 4e-6f)),
                             std::pair(flat_grid(40, 0.0f), flat_grid(3, 0.0f)),
                             std::pair(fan(200, 0.0f), fan(200, 4e-6f))}) {
    const auto found = hausdorff_distance(a, b, 1e-6, "grids");
    ASSERT_TRUE(found);
    EXPECT_LT(found->lower_m, 1e-8);
    EXPECT_LE(found->upper_m, found->lower_m + 1e-6);
    const auto apart = hausdorff_distance(a, shifted(b, 0.001f), 1e-6, "grids");
    ASSERT_TRUE(apart);
    EXPECT_LE(apart->lower_m, 0.0010001);
    EXPECT_GE(apart->upper_m, 0.0009999);
    EXPECT_LE(apart->upper_m - apart->lower_m, 1.1e-6);
  }
}

TEST(MeshDistance, WithoutASurfaceThereIsNone) {
  Mesh flat = example_patch(1);
  for (auto& p : flat.positions) p = {p[0], 0.0f, 0.0f};
  EXPECT_FALSE(hausdorff_distance(flat, example_cube(), 1e-3, "flat"));
  EXPECT_FALSE(sampled_distance(example_cube(), flat, "flat"));
}

}  // namespace
}  // namespace seedframe
