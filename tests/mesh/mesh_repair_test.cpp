#include "mesh/mesh_repair.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/mesh_buffer.h"
#include "mesh/mesh_measure.h"
#include "mesh/mesh_self_intersections.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

RepairedMesh repaired(const Mesh& mesh, const RepairOptions& options = {}) {
  auto out = repair_mesh(mesh, options, "mesh");
  EXPECT_TRUE(out) << out.error().message;
  return out ? *out : RepairedMesh{};
}

void add_triangle(Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  mesh.triangles.push_back(triangle);
  mesh.triangle_slots.push_back(1);
  mesh.corner_uvs.insert(mesh.corner_uvs.end(), {{0.1f, 0.2f}, {0.3f, 0.4f}, {0.5f, 0.6f}});
}

void turn(Mesh& mesh, std::size_t t) {
  std::swap(mesh.triangles[t][0], mesh.triangles[t][2]);
  std::swap(mesh.corner_uvs[3 * t], mesh.corner_uvs[3 * t + 2]);
}

void append_mesh(Mesh& to, const Mesh& from, float scale, float shift) {
  const auto first = static_cast<std::uint32_t>(to.positions.size());
  for (const auto& p : from.positions) {
    to.positions.push_back({scale * p[0] + shift, scale * p[1], scale * p[2]});
  }
  for (const auto& [a, b, c] : from.triangles) {
    to.triangles.push_back({a + first, b + first, c + first});
  }
  to.corner_uvs.insert(to.corner_uvs.end(), from.corner_uvs.begin(), from.corner_uvs.end());
  to.triangle_slots.insert(to.triangle_slots.end(), from.triangle_slots.begin(),
                           from.triangle_slots.end());
}

TEST(MeshRepair, AMeshWithoutFaultsComesBackBitForBit) {
  for (const Mesh& mesh : {example_cube(), example_patch(9)}) {
    const RepairedMesh out = repaired(mesh);
    EXPECT_FALSE(out.report.changed());
    EXPECT_EQ(mesh_buffer(out.mesh), mesh_buffer(mesh));
  }
}

TEST(MeshRepair, DropsVerticesAndTrianglesThatNobodySees) {
  Mesh mesh = example_cube();
  mesh.positions.push_back({9.0f, 9.0f, 9.0f});
  add_triangle(mesh, {0, 0, 1});
  add_triangle(mesh, mesh.triangles[3]);
  add_triangle(mesh, {mesh.triangles[5][0], mesh.triangles[5][2], mesh.triangles[5][1]});
  const RepairedMesh out = repaired(mesh);
  EXPECT_EQ(out.report.unused_vertices, 1u);
  EXPECT_EQ(out.report.degenerate_triangles, 1u);
  EXPECT_EQ(out.report.duplicate_triangles, 2u);
  EXPECT_EQ(mesh_buffer(out.mesh), mesh_buffer(example_cube()));
}

TEST(MeshRepair, KeepsSliversThatHoldTheSurfaceTogether) {
  Mesh mesh = example_cube();
  // The middle of the edge 0-1 belongs to one of its triangles only; a sliver fills the crack.
  mesh.positions.push_back({0.0f, -1.0f, -1.0f});
  ASSERT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 5}));
  mesh.triangles[0] = {0, 8, 5};
  add_triangle(mesh, {8, 1, 5});
  add_triangle(mesh, {8, 0, 1});
  const RepairedMesh out = repaired(mesh);
  EXPECT_EQ(out.report.kept_slivers, 1u);
  EXPECT_FALSE(out.report.changed());
  EXPECT_TRUE(measure_mesh(out.mesh).watertight);
}

TEST(MeshRepair, JoinsBordersAtTheSamePlaceAndKeepsTheirUvs) {
  const Mesh cube = example_cube();
  Mesh split;
  split.slot_names = cube.slot_names;
  split.triangle_slots = cube.triangle_slots;
  split.corner_uvs = cube.corner_uvs;
  for (const auto& triangle : cube.triangles) {
    const auto first = static_cast<std::uint32_t>(split.positions.size());
    for (const auto v : triangle) split.positions.push_back(cube.positions[v]);
    split.triangles.push_back({first, first + 1, first + 2});
  }
  const RepairedMesh out = repaired(split);
  EXPECT_EQ(out.report.joined_edges, 18u);
  EXPECT_EQ(out.mesh.positions.size(), 8u);
  EXPECT_EQ(out.mesh.corner_uvs, cube.corner_uvs);
  EXPECT_TRUE(measure_mesh(out.mesh).watertight);
}

TEST(MeshRepair, TurnsTrianglesWithTheirUvs) {
  const Mesh cube = example_cube();
  Mesh mesh = cube;
  turn(mesh, 4);
  turn(mesh, 7);
  const RepairedMesh out = repaired(mesh);
  EXPECT_EQ(out.report.turned_triangles, 2u);
  EXPECT_DOUBLE_EQ(signed_volume_6(out.mesh), 48.0);
  // The corner at each position has the UV that it had, whatever the order of corners.
  for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& triangle = out.mesh.triangles[t];
      const auto at = std::find(triangle.begin(), triangle.end(), cube.triangles[t][i]);
      ASSERT_NE(at, triangle.end());
      const auto j = static_cast<std::size_t>(at - triangle.begin());
      EXPECT_EQ(out.mesh.corner_uvs[3 * t + j], cube.corner_uvs[3 * t + i]);
    }
  }
}

TEST(MeshRepair, TurnsClosedPartsOutwardButNotTheWallsOfCavities) {
  Mesh inside_out = example_cube();
  for (std::size_t t = 0; t < inside_out.triangles.size(); ++t) turn(inside_out, t);
  const RepairedMesh out = repaired(inside_out);
  EXPECT_EQ(out.report.inside_out_parts, 1u);
  EXPECT_DOUBLE_EQ(signed_volume_6(out.mesh), 48.0);

  Mesh hollow = example_cube();
  append_mesh(hollow, inside_out, 0.5f, 0.0f);
  EXPECT_FALSE(repaired(hollow).report.changed());
  Mesh beside = example_cube();
  append_mesh(beside, inside_out, 0.5f, 5.0f);
  EXPECT_EQ(repaired(beside).report.inside_out_parts, 1u);
}

TEST(MeshRepair, TakesNonManifoldEdgesAndVerticesApart) {
  Mesh fin = example_cube();
  fin.positions.push_back({3.0f, 0.0f, 0.0f});
  add_triangle(fin, {5, 1, 8});
  RepairedMesh out = repaired(fin);
  EXPECT_EQ(out.report.non_manifold_edges, 1u);
  EXPECT_EQ(measure_mesh(out.mesh).bad_edges, 0u);
  EXPECT_TRUE(count_self_intersections(out.mesh, "fin"));

  Mesh hourglass = example_patch(1);
  append_mesh(hourglass, example_patch(1), -1.0f, 0.0f);
  for (auto& triangle : hourglass.triangles) {
    for (auto& v : triangle) v = v == 4 ? 0 : v;  // both have a corner at the origin
  }
  out = repaired(hourglass);
  EXPECT_EQ(out.report.non_manifold_vertices, 1u);
  EXPECT_EQ(out.report.unused_vertices, 1u);
  EXPECT_EQ(out.mesh.positions.size(), 8u);
}

TEST(MeshRepair, FillsHolesOnRequestUpToTheirSize) {
  Mesh open = example_cube();
  open.triangles.resize(10);
  open.triangle_slots.resize(10);
  open.corner_uvs.resize(30);
  EXPECT_FALSE(repaired(open).report.changed());
  EXPECT_EQ(repaired(open, {.fill_holes = 3}).report.filled_holes, 0u);
  const RepairedMesh out = repaired(open, {.fill_holes = 4});
  EXPECT_EQ(out.report.filled_holes, 1u);
  EXPECT_EQ(out.report.added_triangles, 2u);
  EXPECT_TRUE(measure_mesh(out.mesh).watertight);
  EXPECT_DOUBLE_EQ(signed_volume_6(out.mesh), 48.0);
  EXPECT_TRUE(check_mesh(out.mesh, "filled"));
}

TEST(MeshRepair, SlotsWithoutTrianglesAreDropped) {
  Mesh mesh = example_cube();
  mesh.slot_names = {"none", "sides", "doubled", "caps", "last"};
  for (std::uint32_t& slot : mesh.triangle_slots) slot = slot == 0 ? 1 : 3;
  const std::size_t triangles = mesh.triangles.size();
  for (std::size_t t = 0; t < triangles; ++t) {  // each once more, the other way round
    add_triangle(mesh, {mesh.triangles[t][0], mesh.triangles[t][2], mesh.triangles[t][1]});
    mesh.triangle_slots.back() = 2;
  }
  const RepairedMesh out = repaired(mesh);
  EXPECT_EQ(out.report.duplicate_triangles, triangles);
  EXPECT_EQ(out.report.unused_slots, 3u);
  EXPECT_EQ(out.mesh.slot_names, (std::vector<std::string>{"sides", "caps"}));
  EXPECT_EQ(out.mesh.triangle_slots, example_cube().triangle_slots);
}

TEST(MeshRepair, NothingLeftIsAnError) {
  Mesh mesh = example_patch(1);
  mesh.triangles = {{0, 0, 1}, {2, 2, 3}};
  EXPECT_FALSE(repair_mesh(mesh, {}, "mesh"));
}

TEST(MeshMeasure, KnowsTheCube) {
  const MeshMeasures m = measure_mesh(example_cube());
  EXPECT_TRUE(m.watertight);
  EXPECT_DOUBLE_EQ(m.size_m, 2.0);
  EXPECT_DOUBLE_EQ(m.area_m2, 24.0);
  EXPECT_DOUBLE_EQ(m.volume_m3.value_or(0.0), 8.0);
  EXPECT_EQ(m.genus.value_or(-1), 0);
  EXPECT_EQ(m.parts, 1u);
  EXPECT_EQ(*count_self_intersections(example_cube(), "cube"), 0u);
}

TEST(MeshMeasure, KnowsOpenMeshesAxesAndCrossings) {
  const MeshMeasures patch = measure_mesh(example_patch(10));
  EXPECT_FALSE(patch.watertight);
  EXPECT_EQ(patch.boundary_edges, 40u);
  EXPECT_FALSE(patch.volume_m3 || patch.genus);
  EXPECT_GT(patch.principal_axes(0, 0), 0.99) << "0.3 m along x, 0.2 m along y";
  EXPECT_NEAR(patch.principal_size_m[0], 0.3, 0.01);
  EXPECT_NEAR(patch.principal_axes.determinant(), 1.0, 1e-12);
  Mesh crossed = example_cube();
  append_mesh(crossed, example_cube(), 1.0f, 1.0f);
  EXPECT_GT(*count_self_intersections(crossed, "crossed"), 0u);
  EXPECT_EQ(measure_mesh(crossed).parts, 2u);
}

}  // namespace
}  // namespace seedframe
