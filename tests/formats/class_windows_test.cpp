#include "formats/class_windows.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

constexpr int kFieldClass = 4;
constexpr int kLineClass = 5;

Image<std::uint8_t> field_of(int width, int height) {
  Image<std::uint8_t> classes(width, height);
  std::fill(classes.values.begin(), classes.values.end(), std::uint8_t{kFieldClass});
  return classes;
}

void fill(Image<std::uint8_t>& classes, const PixelRect& rect, int category) {
  for (int row = rect.y; row < rect.end_y(); ++row) {
    for (int column = rect.x; column < rect.end_x(); ++column) {
      classes.at(row, column) = static_cast<std::uint8_t>(category);
    }
  }
}

std::int64_t pixels_of(const Image<std::uint8_t>& classes, const PixelRect& rect, int category) {
  std::int64_t count = 0;
  for (int row = rect.y; row < rect.end_y(); ++row) {
    for (int column = rect.x; column < rect.end_x(); ++column) {
      count += classes.at(row, column) == category;
    }
  }
  return count;
}

class ClassWindows : public ::testing::Test {
 protected:
  std::optional<PixelRect> draw(const Image<std::uint8_t>& classes, const WindowRule& rule,
                                std::uint32_t frame) const {
    return draw_window(classes, rule, sides_, places_, {.frame = frame, .copy = 0});
  }

 private:
  PhiloxStream sides_{7, "sides"};
  PhiloxStream places_{7, "places"};
};

TEST_F(ClassWindows, HoldNothingElseOfACrowdedImage) {
  Image<std::uint8_t> classes = field_of(160, 120);
  for (int i = 0; i < 9; ++i) fill(classes, {i * 17, (i * 29) % 110, 6, 9}, 1 + i % 3);
  fill(classes, {0, 0, 160, 20}, 0);
  std::set<int> sides;
  for (std::uint32_t frame = 0; frame < 300; ++frame) {
    const auto window = draw(classes, {.category = kFieldClass}, frame);
    ASSERT_TRUE(window);
    EXPECT_EQ(window->width, window->height);
    EXPECT_EQ(pixels_of(classes, *window, kFieldClass), window->area());
    sides.insert(window->width);
  }
  EXPECT_GE(*sides.begin(), kLeastWindowSide);
  EXPECT_GT(sides.size(), 5U);
}

TEST_F(ClassWindows, AreAnywhereWithTheSameProbability) {
  const Image<std::uint8_t> classes = field_of(40, 16);  // one side, 25 places
  std::array<int, 25> places{};
  constexpr int kDraws = 5000;
  for (std::uint32_t frame = 0; frame < kDraws; ++frame) {
    const auto window = draw(classes, {.category = kFieldClass}, frame);
    ASSERT_TRUE(window);
    ASSERT_EQ(window->width, 16);
    ++places.at(static_cast<std::size_t>(window->x));
  }
  double chi_square = 0.0;
  for (const int count : places) chi_square += (count - 200.0) * (count - 200.0) / 200.0;
  EXPECT_LT(chi_square, 52.6);  // 24 degrees of freedom, p = 0.001 is 51.2; the draws are fixed
}

TEST_F(ClassWindows, AreNotWhereThereIsNoRoom) {
  Image<std::uint8_t> classes = field_of(64, 64);
  for (int row = 0; row < 64; row += 15) fill(classes, {0, row, 64, 1}, 1);
  EXPECT_FALSE(draw(classes, {.category = kFieldClass}, 0));
  for (int row = 45; row < 64; row += 15) fill(classes, {0, row, 64, 1}, kFieldClass);
  const auto window = draw(classes, {.category = kFieldClass}, 0);
  ASSERT_TRUE(window);
  EXPECT_GT(window->y, 30);
  EXPECT_FALSE(draw(classes, {.category = kFieldClass, .min_side = 40}, 0));
  EXPECT_FALSE(draw(classes, {.category = kFieldClass, .min_side = 65}, 0));
}

TEST_F(ClassWindows, OfALineShowFieldBesideItAndEnoughOfIt) {
  Image<std::uint8_t> classes = field_of(120, 120);
  fill(classes, {0, 60, 120, 6}, kLineClass);
  fill(classes, {0, 0, 50, 120}, 1);  // a robot before both
  for (std::uint32_t frame = 0; frame < 200; ++frame) {
    const auto window = draw(classes, {.category = kLineClass, .beside = {kFieldClass}}, frame);
    ASSERT_TRUE(window);
    const std::int64_t own = pixels_of(classes, *window, kLineClass);
    EXPECT_GE(own, kLeastOwnShare * window->area());
    EXPECT_EQ(own + pixels_of(classes, *window, kFieldClass), window->area());
  }
  EXPECT_FALSE(draw(classes, {.category = kLineClass}, 0));  // nothing but the line: it is too thin
}

TEST_F(ClassWindows, OfAnImageThatIsSmallerThanTheyAreUsually) {
  const Image<std::uint8_t> classes = field_of(9, 7);
  const auto window = draw(classes, {.category = kFieldClass}, 0);
  ASSERT_TRUE(window);
  EXPECT_EQ(window->width, 7);
}

TEST_F(ClassWindows, ClassesComeFromTheIdsOfTheFrame) {
  FrameLabels labels;
  InstanceLabel ball;
  ball.id = 300;
  ball.category = 2;
  InstanceLabel distractor;
  distractor.id = 4;
  labels.instances = {ball, distractor};
  Image<std::uint16_t> ids(3, 1);
  ids.values = {300, 4, 0};
  EXPECT_EQ(class_image(labels, ids).values, (std::vector<std::uint8_t>{2, 0, 0}));
}

}  // namespace
}  // namespace seedframe
