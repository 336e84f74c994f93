#include "mesh/mesh_diameter.h"

#include <random>

#include <gtest/gtest.h>

#include "mesh/primitives.h"

namespace seedframe {
namespace {

Mesh points(const std::vector<std::array<float, 3>>& positions) {
  Mesh mesh;
  mesh.positions = positions;
  return mesh;
}

double by_every_pair(const Mesh& mesh) {
  double most = 0.0;
  for (const auto& a : mesh.positions) {
    for (const auto& b : mesh.positions) {
      const Eigen::Vector3d from(a[0], a[1], a[2]);
      const Eigen::Vector3d to(b[0], b[1], b[2]);
      most = std::max(most, (from - to).norm());
    }
  }
  return most;
}

TEST(MeshDiameter, IsThatOfEveryPair) {
  std::mt19937_64 random(11);
  std::normal_distribution<float> normal;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::array<float, 3>> positions;
    for (int i = 0; i < 500; ++i) {
      std::array<float, 3> p = {normal(random), normal(random), normal(random)};
      if (trial % 2 == 0) {  // on a sphere every vertex has one nearly as far as the farthest
        const float length = std::hypot(p[0], p[1], p[2]);
        for (float& x : p) x /= length;
      }
      positions.push_back(p);
    }
    const Mesh mesh = points(positions);
    EXPECT_DOUBLE_EQ(mesh_diameter(mesh), by_every_pair(mesh));
  }
}

TEST(MeshDiameter, OfFlatAndOfSingleVertices) {
  EXPECT_EQ(mesh_diameter(points({})), 0.0);
  EXPECT_EQ(mesh_diameter(points({{1, 2, 3}})), 0.0);
  EXPECT_EQ(mesh_diameter(points({{0, 0, 0}, {3, 4, 0}, {1, 1, 0}})), 5.0);
}

}  // namespace
}  // namespace seedframe
