#include "picture/label_colors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

double distance(const DisplayColor& a, const DisplayColor& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// As somebody without red cones sees it, roughly: Viénot, Brettel and Mollon (1999), on display
/// values.
DisplayColor as_protanope(const DisplayColor& c) {
  return {0.11238 * c[0] + 0.88762 * c[1], 0.11238 * c[0] + 0.88762 * c[1],
          0.00401 * c[0] - 0.00401 * c[1] + c[2]};
}

TEST(ClassColor, OfManyClassesDiffers) {
  for (int a = 1; a <= 24; ++a) {
    for (int b = a + 1; b <= 24; ++b) {
      EXPECT_GT(distance(class_color(a), class_color(b)), 0.15) << a << " and " << b;
    }
  }
}

TEST(ClassColor, OfTheFirstEightDiffersForOtherEyesToo) {
  for (int a = 1; a <= 8; ++a) {
    for (int b = a + 1; b <= 8; ++b) {
      EXPECT_GT(distance(as_protanope(class_color(a)), as_protanope(class_color(b))), 0.1)
          << a << " and " << b;
    }
  }
}

TEST(ClassColor, IsOfADisplayWhateverTheNumber) {
  for (int category : {-1, 0, 1, 8, 9, 80, 1000, 65535}) {
    for (const double channel : class_color(category)) {
      EXPECT_GE(channel, 0.0);
      EXPECT_LE(channel, 1.0);
    }
  }
  EXPECT_EQ(class_color(0)[0], class_color(0)[1]) << "a distractor is grey";
}

TEST(InstanceColor, OfFiveOfAClassDiffers) {
  for (int category = 0; category <= 12; ++category) {
    for (std::size_t a = 0; a < 5; ++a) {
      for (std::size_t b = a + 1; b < 5; ++b) {
        EXPECT_GT(distance(instance_color(category, a), instance_color(category, b)), 0.03)
            << category << ": " << a << " and " << b;
      }
    }
  }
  EXPECT_EQ(instance_color(3, 0), class_color(3));
}

TEST(InkOn, IsReadOnWhatIsBehindIt) {
  EXPECT_EQ(ink_on({1.0, 1.0, 1.0})[0], 0.0);
  EXPECT_EQ(ink_on({0.0, 0.0, 0.0})[0], 1.0);
  EXPECT_EQ(ink_on({0.94, 0.89, 0.26})[0], 0.0);
}

TEST(DepthColor, GetsLighterAllTheWay) {
  double before = -1.0;
  for (double share = -0.5; share <= 1.5; share += 0.125) {
    const DisplayColor color = depth_color(share);
    const double light = 0.21 * color[0] + 0.72 * color[1] + 0.07 * color[2];
    EXPECT_GE(light, before);
    before = light;
  }
  EXPECT_EQ(depth_color(-3.0), depth_color(0.0));
}

TEST(ColorBytes, AreRounded) {
  EXPECT_EQ(color_bytes({0.0, 0.5, 1.0}), (std::array<std::uint8_t, 3>{0, 128, 255}));
  EXPECT_EQ(color_bytes({-1.0, 2.0, 0.2}), (std::array<std::uint8_t, 3>{0, 255, 51}));
}

}  // namespace
}  // namespace seedframe
