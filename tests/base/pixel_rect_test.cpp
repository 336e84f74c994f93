#include "base/pixel_rect.h"

#include <limits>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(PixelRect, EndsBehindItsLastPixel) {
  const PixelRect rect{2, 3, 4, 1};
  EXPECT_EQ(rect.end_x(), 6);
  EXPECT_EQ(rect.end_y(), 4);
  EXPECT_TRUE(rect.contains(2, 3));
  EXPECT_TRUE(rect.contains(5, 3));
  EXPECT_FALSE(rect.contains(6, 3));
  EXPECT_FALSE(rect.contains(5, 4));
  EXPECT_FALSE(rect.contains(1, 3));
  EXPECT_FALSE(rect.contains(2, 2));
}

TEST(PixelRect, OneWithoutWidthOrHeightIsEmptyAndHoldsNothing) {
  EXPECT_TRUE(PixelRect{}.empty());
  EXPECT_TRUE((PixelRect{5, 5, 0, 3}).empty());
  EXPECT_TRUE((PixelRect{5, 5, 3, -1}).empty());
  EXPECT_FALSE((PixelRect{-5, -5, 1, 1}).empty());
  EXPECT_FALSE((PixelRect{5, 5, 0, 3}).contains(5, 5));
}

TEST(PixelRect, ItsAreaDoesNotOverflow) {
  constexpr int kMost = std::numeric_limits<int>::max();
  EXPECT_EQ((PixelRect{0, 0, kMost, kMost}).area(), std::int64_t{kMost} * kMost);
}

TEST(PixelRect, AUnionHoldsBothAndNoMore) {
  EXPECT_EQ(union_of({0, 0, 1, 1}, {3, 5, 1, 2}), (PixelRect{0, 0, 4, 7}));
  EXPECT_EQ(union_of({3, 5, 1, 2}, {0, 0, 1, 1}), (PixelRect{0, 0, 4, 7}));
  EXPECT_EQ(union_of({-4, -4, 20, 20}, {0, 0, 1, 1}), (PixelRect{-4, -4, 20, 20}));
}

TEST(PixelRect, AnEmptyOneAddsNothingToAUnion) {
  EXPECT_EQ(union_of({}, {3, 5, 1, 2}), (PixelRect{3, 5, 1, 2}));
  EXPECT_EQ(union_of({3, 5, 1, 2}, {-100, 100, 0, 7}), (PixelRect{3, 5, 1, 2}));
}

}  // namespace
}  // namespace seedframe
