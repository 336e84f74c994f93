#include "annotate/smallest_rectangle.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "annotate/extents.h"
#include "tests/annotate/mask_cases.h"

namespace seedframe {
namespace {

double area_of(const OrientedBox& box) {
  const auto side = [&](std::size_t i, std::size_t j) {
    return std::hypot(box.corners[i][0] - box.corners[j][0], box.corners[i][1] - box.corners[j][1]);
  };
  return side(0, 1) * side(1, 2);
}

/// The rectangle around all pixel squares with a side at an angle: its area, or infinity if it
/// leaves the image and must not.
double area_at(const Mask& mask, double angle, bool in_image = false) {
  double low_u = 1e300, high_u = -1e300, low_v = 1e300, high_v = -1e300;
  const PixelRect& box = mask.box();
  for (int row = box.y; row < box.end_y(); ++row) {
    for (int column = box.x; column < box.end_x(); ++column) {
      if (!mask.at(row, column)) continue;
      for (const int dy : {0, 1}) {
        for (const int dx : {0, 1}) {
          const double u = (column + dx) * std::cos(angle) + (row + dy) * std::sin(angle);
          const double v = (row + dy) * std::cos(angle) - (column + dx) * std::sin(angle);
          low_u = std::min(low_u, u);
          high_u = std::max(high_u, u);
          low_v = std::min(low_v, v);
          high_v = std::max(high_v, v);
        }
      }
    }
  }
  for (const double u : {low_u, high_u}) {
    for (const double v : {low_v, high_v}) {
      const double x = u * std::cos(angle) - v * std::sin(angle);
      const double y = u * std::sin(angle) + v * std::cos(angle);
      const bool inside = x >= 0 && y >= 0 && x <= mask.image_width() && y <= mask.image_height();
      if (in_image && !inside) return std::numeric_limits<double>::infinity();
    }
  }
  return (high_u - low_u) * (high_v - low_v);
}

TEST(SmallestRectangle, OfOnePixelIsThePixel) {
  IdImage ids(12, 10);
  ids.at(4, 7) = 3;
  const OrientedBox box = smallest_rectangle(only_mask(ids));
  EXPECT_TRUE(box.smallest);
  const std::array<std::array<double, 2>, 4> pixel = {{{7, 4}, {8, 4}, {8, 5}, {7, 5}}};
  EXPECT_EQ(box.corners, pixel);
}

TEST(SmallestRectangle, FollowsADiagonal) {
  IdImage ids(60, 60);
  for (int i = 10; i < 50; ++i) ids.at(i, i) = ids.at(i, i + 1) = 1;
  const Mask mask = only_mask(ids);
  const OrientedBox box = smallest_rectangle(mask);
  EXPECT_TRUE(box.smallest);
  EXPECT_LT(area_of(box), 150.0) << "the upright box has 1640";
}

TEST(SmallestRectangle, IsNoLargerThanAnyAtAnAngleAndHoldsEveryPixel) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    IdImage ids(100, 100);
    const double angle = static_cast<double>(random() % 1000) / 1000.0 * 3.14159;
    for (int row = 0; row < 100; ++row) {
      for (int column = 0; column < 100; ++column) {
        const double u = (column - 50) * std::cos(angle) + (row - 50) * std::sin(angle);
        const double v = (row - 50) * std::cos(angle) - (column - 50) * std::sin(angle);
        if (u * u / 900 + v * v / (4.0 + trial) < 1.0) ids.at(row, column) = 1;
      }
    }
    const Mask mask = only_mask(ids);
    const OrientedBox box = smallest_rectangle(mask);
    ASSERT_TRUE(box.smallest);
    for (double other = 0.0; other < 1.58; other += 0.01) {
      EXPECT_LE(area_of(box), area_at(mask, other) + 1e-6);
    }
    // Along its own side, the rectangle around the pixels is the same one.
    const double side =
        std::atan2(box.corners[1][1] - box.corners[0][1], box.corners[1][0] - box.corners[0][0]);
    EXPECT_NEAR(area_at(mask, side), area_of(box), 1e-6);
  }
}

TEST(SmallestRectangle, StaysInTheImage) {
  std::mt19937_64 random(9);
  int others = 0;
  for (int trial = 0; trial < 200; ++trial) {
    IdImage ids(40, 30);
    const int x = static_cast<int>(random() % 40);
    const int y = static_cast<int>(random() % 30);
    for (int row = 0; row < 30; ++row) {
      for (int column = 0; column < 40; ++column) {
        const double along = (column - x) * 0.8 + (row - y) * 0.6;
        const double across = (row - y) * 0.8 - (column - x) * 0.6;
        if (std::hypot(along / 14.0, across / 4.0) < 1.0) ids.at(row, column) = 1;
      }
    }
    const Mask mask = only_mask(ids);
    const OrientedBox box = smallest_rectangle(mask);
    others += !box.smallest;
    for (double angle = 0.0; angle < 1.58; angle += 0.005) {
      EXPECT_LE(area_of(box), area_at(mask, angle, true) + 1e-6) << trial << " " << angle;
    }
    for (const auto& [cx, cy] : box.corners) {
      EXPECT_GE(cx, 0.0);
      EXPECT_LE(cx, 40.0);
      EXPECT_GE(cy, 0.0);
      EXPECT_LE(cy, 30.0);
    }
  }
  EXPECT_GE(others, 20);
}

}  // namespace
}  // namespace seedframe
