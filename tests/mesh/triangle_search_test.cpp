#include "mesh/triangle_search.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "mesh/triangle_distance.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

std::vector<TriangleCorners> triangles_of(const Mesh& mesh) {
  std::vector<TriangleCorners> triangles;
  for (const auto& triangle : mesh.triangles) {
    TriangleCorners corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& p = mesh.positions[triangle[i]];
      corners[i] = Eigen::Vector3d(p[0], p[1], p[2]);
    }
    triangles.push_back(corners);
  }
  return triangles;
}

TEST(TriangleSearch, FindsWhatLookingAtEveryTriangleFinds) {
  for (const std::uint32_t n : {1u, 2u, 15u}) {
    const TriangleSearch search(triangles_of(example_patch(n)));
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d p(0.0031 * i - 0.1, 0.4 * std::sin(i), 0.05 * std::cos(3.0 * i));
      double least = 1e300;
      for (const auto& [a, b, c] : search.triangles()) {
        least = std::min(least, squared_distance_to_triangle(p, a, b, c));
      }
      const TriangleSearch::Nearest nearest = search.nearest(p);
      EXPECT_EQ(nearest.squared_distance, least);
      const auto& [a, b, c] = search.triangles()[nearest.triangle];
      EXPECT_EQ(squared_distance_to_triangle(p, a, b, c), least);
      EXPECT_TRUE(search.any_within(p, least));
      EXPECT_FALSE(search.any_within(p, least * (1.0 - 1e-12) - 1e-300));
    }
  }
}

TEST(TriangleDistance, IsThatOfTheNearestPoint) {
  const auto wave = [](int i, double frequency) { return std::sin(frequency * i); };
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d a(wave(i, 1.1), wave(i, 2.3), wave(i, 3.7));
    const Eigen::Vector3d b(wave(i, 4.9), wave(i, 5.3), wave(i, 6.1));
    Eigen::Vector3d c(wave(i, 7.9), wave(i, 8.3), wave(i, 9.1));
    const Eigen::Vector3d p(2.0 * wave(i, 0.7), 2.0 * wave(i, 0.9), 2.0 * wave(i, 1.3));
    if (i % 4 == 1) c = 0.5 * (a + b);                                     // in a line
    if (i % 4 == 2) c = a + 1e-6 * Eigen::Vector3d(1.0, 0.0, wave(i, 2));  // a sliver
    if (i % 8 == 3) c = b;
    const Eigen::Vector3d w = nearest_weights(p, a, b, c);
    const double expected = (w.x() * a + w.y() * b + w.z() * c - p).squaredNorm();
    EXPECT_NEAR(squared_distance_to_triangle(p, a, b, c), expected, 1e-12) << i;
  }
}

TEST(TriangleSearch, OfNothingFindsNothing) {
  const TriangleSearch search({});
  EXPECT_TRUE(search.empty());
  EXPECT_FALSE(search.any_within(Eigen::Vector3d::Zero(), 1e9));
}

}  // namespace
}  // namespace seedframe
