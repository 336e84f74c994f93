#include "mesh_files/triangulate.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

// The area of the pieces with their sign against `up`, and without it. They agree when no piece is
// turned over; they agree with the polygon's when the pieces do not overlap either.
struct Areas {
  double with_sign = 0.0;
  double without_sign = 0.0;
};

Areas areas_of_pieces(const Corners& corners, const Eigen::Vector3d& up) {
  Areas areas;
  for (const auto& [a, b, c] : triangulate(corners)) {
    const Eigen::Vector3d normal = (corners[b] - corners[a]).cross(corners[c] - corners[a]);
    areas.with_sign += 0.5 * normal.dot(up);
    areas.without_sign += 0.5 * normal.norm();
  }
  return areas;
}

TEST(Triangulate, LeavesATriangleAndDropsLess) {
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 1u);
  EXPECT_TRUE(triangulate({{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST(Triangulate, CutsAQuadAlongItsShorterDiagonal) {
  const auto pieces = triangulate({{0, 0, 0}, {2, -1, 0}, {4, 0, 0}, {2, 1, 0}});
  ASSERT_EQ(pieces.size(), 2u);
  for (const auto& piece : pieces) {
    EXPECT_EQ(std::count(piece.begin(), piece.end(), 1u), 1);
    EXPECT_EQ(std::count(piece.begin(), piece.end(), 3u), 1);
  }
}

TEST(Triangulate, KeepsTheAreaOfConcavePolygonsInEveryOrientation) {
  const Corners letter_l{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}};
  for (int turn = 0; turn < 24; ++turn) {
    const Eigen::Matrix3d rotation =
        (Eigen::AngleAxisd(0.7 * turn, Eigen::Vector3d(1, 2, 3).normalized()) *
         Eigen::AngleAxisd(0.3 * turn, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    Corners corners;
    for (const auto& corner : letter_l) {
      corners.push_back(rotation * corner + Eigen::Vector3d(1e4, -1e4, 5.0));
    }
    const Areas areas = areas_of_pieces(corners, rotation * Eigen::Vector3d::UnitZ());
    EXPECT_EQ(triangulate(corners).size(), 4u);
    EXPECT_NEAR(areas.with_sign, 6.0, 1e-9);
    EXPECT_NEAR(areas.without_sign, 6.0, 1e-9);
  }
}

TEST(Triangulate, TakesAHoleThatABridgeJoinsToTheOutline) {
  const Corners frame{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                      {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  const Areas areas = areas_of_pieces(frame, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(areas.with_sign, 12.0, 1e-12);
  EXPECT_NEAR(areas.without_sign, 12.0, 1e-12);
}

TEST(Triangulate, EndsOnWhatIsNotAPolygon) {
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);  // a bow tie
  EXPECT_EQ(triangulate(Corners(5, Eigen::Vector3d(1, 1, 1))).size(), 3u);
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size(), 2u);
}

}  // namespace
}  // namespace seedframe
