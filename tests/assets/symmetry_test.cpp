#include "assets/symmetry.h"

#include <gtest/gtest.h>

#include "assets/asset_library.h"
#include "mesh/mesh_diameter.h"

namespace seedframe {
namespace {

Symmetries symmetries_of(const std::string& name) {
  const auto library = AssetLibrary::open({SEEDFRAME_HOME "/assets"});
  EXPECT_TRUE(library);
  const auto asset = library->load(name);
  EXPECT_TRUE(asset) << name;
  const Mesh& mesh = (*asset)->mesh;
  return find_symmetries(mesh, 0.02 * mesh_diameter(mesh));
}

TEST(Symmetry, ACubeHasTwentyFourRotations) {
  const Symmetries cube = symmetries_of("cube");
  EXPECT_EQ(cube.rotations.size(), 23U);
  EXPECT_TRUE(cube.axes.empty());
  for (const Eigen::Matrix3d& rotation : cube.rotations) {
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-9);
  }
}

TEST(Symmetry, ACylinderTurnsAboutItsAxisAndOver) {
  const Symmetries cylinder = symmetries_of("cylinder");
  ASSERT_EQ(cylinder.axes.size(), 1U);
  EXPECT_NEAR(std::abs(cylinder.axes[0].z()), 1.0, 1e-3);
  ASSERT_EQ(cylinder.rotations.size(), 1U);
  EXPECT_NEAR(cylinder.rotations[0](2, 2), -1.0, 1e-3);
}

TEST(Symmetry, AConeTurnsAboutItsAxisAndNotOver) {
  const Symmetries cone = symmetries_of("cone");
  EXPECT_EQ(cone.axes.size(), 1U);
  EXPECT_TRUE(cone.rotations.empty());
}

TEST(Symmetry, ASphereTurnsAboutAnyAxis) {
  const Symmetries sphere = symmetries_of("sphere");
  EXPECT_EQ(sphere.axes.size(), 3U);
  EXPECT_TRUE(sphere.rotations.empty());
}

TEST(Symmetry, AHexNutHasTwelveRotationsWhateverItsThreadDoes) {
  EXPECT_EQ(symmetries_of("hex_nut").rotations.size(), 11U);
}

TEST(Symmetry, AHexBoltHasSixAndIsNotTakenForSomethingRounder) {
  EXPECT_EQ(symmetries_of("hex_bolt").rotations.size(), 5U);
}

TEST(Symmetry, AKeywayBreaksThatOfAGear) {
  EXPECT_TRUE(symmetries_of("gear").axes.empty());
  EXPECT_TRUE(symmetries_of("gear").rotations.empty());
}

TEST(Symmetry, AMugHasNone) {
  const Symmetries mug = symmetries_of("mug");
  EXPECT_TRUE(mug.axes.empty());
  EXPECT_TRUE(mug.rotations.empty());
}

TEST(Symmetry, TheCentreIsThatOfTheSurface) {
  Mesh mesh;
  mesh.positions = {{10, 0, 0}, {12, 0, 0}, {12, 2, 0}, {10, 2, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.corner_uvs.assign(6, {0.0F, 0.0F});
  mesh.triangle_slots = {0, 0};
  mesh.slot_names = {"s"};
  const Symmetries square = find_symmetries(mesh, 0.001);
  EXPECT_NEAR((square.centre - Eigen::Vector3d(11, 1, 0)).norm(), 0.0, 1e-6);
  EXPECT_EQ(square.rotations.size(), 7U);  // turned in its plane, and over
}

}  // namespace
}  // namespace seedframe
