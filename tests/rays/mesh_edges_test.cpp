#include "rays/mesh_edges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

std::vector<MeshEdge> edges_of(const Mesh& mesh) {
  return edges_of_closed_mesh(mesh.positions, mesh.triangles);
}

TEST(MeshEdges, OfACubeAreEighteen) {
  const Mesh cube = example_cube();
  const std::vector<MeshEdge> edges = edges_of(cube);
  EXPECT_THAT(edges, SizeIs(18));
  const auto runs = [&](std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
    const auto& corners = cube.triangles[triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& a = cube.positions[corners[i]];
      const auto& b = cube.positions[corners[(i + 1) % 3]];
      if (a == cube.positions[from] && b == cube.positions[to]) return true;
    }
    return false;
  };
  for (const MeshEdge& edge : edges) {
    EXPECT_TRUE(runs(edge.triangle, edge.from, edge.to));
    EXPECT_TRUE(runs(edge.opposite, edge.to, edge.from));
  }
}

TEST(MeshEdges, VerticesAtOnePlaceAreOne) {
  Mesh cube = example_cube();
  Mesh apart = cube;
  apart.positions.clear();
  for (std::array<std::uint32_t, 3>& triangle : apart.triangles) {
    for (std::uint32_t& corner : triangle) {
      apart.positions.push_back(cube.positions[corner]);
      corner = static_cast<std::uint32_t>(apart.positions.size() - 1);
    }
  }
  EXPECT_THAT(edges_of(apart), SizeIs(18));
}

TEST(MeshEdges, AMeshWithAHoleHasNone) {
  Mesh cube = example_cube();
  cube.triangles.pop_back();
  EXPECT_THAT(edges_of(cube), IsEmpty());
}

TEST(MeshEdges, AMeshWithATriangleTurnedRoundHasNone) {
  Mesh cube = example_cube();
  std::swap(cube.triangles[3][0], cube.triangles[3][1]);
  EXPECT_THAT(edges_of(cube), IsEmpty());
}

TEST(MeshEdges, TwoBodiesThatShareAnEdgeAreClosed) {
  Mesh cubes = example_cube();
  const Mesh other = example_cube();
  const auto vertices = static_cast<std::uint32_t>(cubes.positions.size());
  const float size = 2.0F * std::abs(other.positions[0][0]);
  for (auto [x, y, z] : other.positions) cubes.positions.push_back({x + size, y + size, z});
  for (const auto& [a, b, c] : other.triangles) {
    cubes.triangles.push_back({a + vertices, b + vertices, c + vertices});
  }
  EXPECT_THAT(edges_of(cubes), SizeIs(36));
}

TEST(MeshEdges, NothingHasNone) { EXPECT_THAT(edges_of({}), IsEmpty()); }

}  // namespace
}  // namespace seedframe
