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

TEST(TriangleSearch, FindsAllThatAreNearABox) {
  const TriangleSearch search(triangles_of(example_patch(20)));
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.1, 0.05, -1.0), Eigen::Vector3d(0.12, 0.1, 1.0));
  std::vector<std::uint32_t> found = search.near_box(box, 0.01);
  std::sort(found.begin(), found.end());
  std::vector<std::uint32_t> expected;
  const Eigen::AlignedBox3d wide(box.min().array() - 0.01, box.max().array() + 0.01);
  for (std::uint32_t t = 0; t < search.triangles().size(); ++t) {
    const auto& [a, b, c] = search.triangles()[t];
    if (Eigen::AlignedBox3d(a).extend(b).extend(c).intersects(wide)) expected.push_back(t);
  }
  EXPECT_EQ(found, expected);
  EXPECT_GT(found.size(), 10u);
  EXPECT_LT(found.size(), 400u);
}

TEST(TriangleSearch, OfNothingFindsNothing) {
  const TriangleSearch search({});
  EXPECT_TRUE(search.empty());
  EXPECT_FALSE(search.any_within(Eigen::Vector3d::Zero(), 1e9));
  EXPECT_TRUE(search.near_box(Eigen::AlignedBox3d(Eigen::Vector3d::Zero()), 1.0).empty());
}

}  // namespace
}  // namespace seedframe
