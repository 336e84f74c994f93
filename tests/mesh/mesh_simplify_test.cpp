#include "mesh/mesh_simplify.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "mesh/mesh_buffer.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_measure.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

Mesh simplified(const Mesh& mesh, double tolerance_m) {
  auto simplifier = MeshSimplifier::create(mesh, "mesh");
  EXPECT_TRUE(simplifier) << simplifier.error().message;
  const Status status = simplifier->simplify(tolerance_m);
  EXPECT_TRUE(status) << status.error().message;
  return simplifier->mesh();
}

TEST(MeshSimplifier, SavesTrianglesWithinTheTolerance) {
  const Mesh fine = example_patch(40);
  std::size_t before = fine.triangles.size();
  for (const double tolerance : {1e-4, 5e-4, 2e-3}) {
    const Mesh coarse = simplified(fine, tolerance);
    EXPECT_LT(coarse.triangles.size(), before);
    before = coarse.triangles.size();
    ASSERT_TRUE(check_mesh(coarse, "coarse"));
    const auto distance = hausdorff_distance(fine, coarse, tolerance / 10.0, "patches");
    ASSERT_TRUE(distance);
    EXPECT_LT(distance->upper_m, 2.0 * tolerance);
  }
}

TEST(MeshSimplifier, KeepsACubeWithItsSeams) {
  const Mesh cube = example_cube();
  const Mesh out = simplified(cube, 0.1);
  EXPECT_EQ(out.triangles.size(), 12u);
  EXPECT_EQ(out.positions.size(), 8u);
  EXPECT_DOUBLE_EQ(signed_volume_6(out), 48.0);
}

TEST(MeshSimplifier, UvsFollowTheSurface) {
  const Mesh fine = example_patch(40);  // u is 10 · x, v is 10 · y
  const Mesh coarse = simplified(fine, 1e-3);
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& p = coarse.positions[coarse.triangles[t][i]];
      EXPECT_NEAR(coarse.corner_uvs[3 * t + i][0], 10.0 * p[0], 0.02);
      EXPECT_NEAR(coarse.corner_uvs[3 * t + i][1], 10.0 * p[1], 0.02);
    }
  }
}

TEST(MeshSimplifier, BordersOfSlotsAndOfTheSurfaceStayWhereTheyAre) {
  Mesh fine = example_patch(40);
  fine.slot_names = {"left", "right"};
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    fine.triangle_slots[t] = (t / 2) % 40 < 20 ? 0 : 1;
  }
  const double tolerance = 1e-3;
  const Mesh coarse = simplified(fine, tolerance);
  EXPECT_LT(coarse.triangles.size(), fine.triangles.size() / 4);
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    for (const auto v : coarse.triangles[t]) {
      const double x = coarse.positions[v][0];
      if (coarse.triangle_slots[t] == 0) {
        EXPECT_LE(x, 0.15 + tolerance);
      }
      if (coarse.triangle_slots[t] == 1) {
        EXPECT_GE(x, 0.15 - tolerance);
      }
    }
  }
  const auto size = bounding_box(coarse).size();
  EXPECT_NEAR(size.x(), 0.3, tolerance);
  EXPECT_NEAR(size.y(), 0.2, tolerance);
}

TEST(MeshSimplifier, IsDeterministicAndGoesOn) {
  const Mesh fine = example_patch(30);
  EXPECT_EQ(mesh_buffer(simplified(fine, 1e-3)), mesh_buffer(simplified(fine, 1e-3)));
  auto simplifier = MeshSimplifier::create(fine, "mesh");
  ASSERT_TRUE(simplifier);
  ASSERT_TRUE(simplifier->simplify(1e-4));
  MeshSimplifier copy = *simplifier;
  ASSERT_TRUE(simplifier->simplify(1e-3));
  ASSERT_TRUE(copy.simplify(1e-3));
  EXPECT_EQ(mesh_buffer(simplifier->mesh()), mesh_buffer(copy.mesh()));
}

TEST(MeshSimplifier, RefusesWhatIsNotAManifold) {
  Mesh mesh = example_cube();
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  EXPECT_FALSE(MeshSimplifier::create(mesh, "mesh"));
}

}  // namespace
}  // namespace seedframe
