#include "preview/display_curve.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

ImageSettings view(const std::string& name, const std::string& look = "None") {
  ImageSettings settings;
  settings.view = name;
  settings.look = look;
  return settings;
}

TEST(DisplayCurve, IsBlackOfNothingAndWhiteOfMuch) {
  for (const char* name : {"Filmic", "Standard", "Raw", "AgX"}) {
    const DisplayCurve curve(view(name), 1.0);
    EXPECT_EQ(curve.code(0.0F), 0) << name;
    EXPECT_EQ(curve.code(-1.0F), 0);
    EXPECT_EQ(curve.code(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(curve.code(1e9F), 255) << name;
    EXPECT_EQ(curve.code(std::numeric_limits<float>::infinity()), 255);
    for (float light = 1e-6F; light < 100.0F; light *= 1.5F) {
      EXPECT_LE(curve.code(light), curve.code(1.5F * light)) << name << light;
    }
  }
}

TEST(DisplayCurve, OfStandardIsSrgb) {
  const DisplayCurve curve(view("Standard"), 1.0);
  EXPECT_NEAR(curve.code(0.21586F), 128, 1);
  EXPECT_NEAR(curve.code(0.50289F), 188, 1);
  EXPECT_NEAR(curve.code(0.003F), 10, 1);
  EXPECT_EQ(DisplayCurve(view("Raw"), 1.0).code(0.5F), 128);
  EXPECT_NEAR(DisplayCurve(view("Standard"), 4.0).code(0.21586F / 4.0F), 128, 1) << "exposed";
  ImageSettings gamma = view("Raw");
  gamma.gamma = 2.0;
  EXPECT_NEAR(DisplayCurve(gamma, 1.0).code(0.25F), 128, 1);
}

/// Codes of greys -6, -4, -2, 0, 2 and 4 stops from 0.18, by the tables of Blender 3.4.
TEST(DisplayCurve, OfFilmicAndItsLooksIsNearTheirTables) {
  const std::map<std::string, std::array<int, 6>> codes = {
      {"Very High Contrast", {2, 9, 41, 128, 215, 247}},
      {"High Contrast", {4, 15, 50, 128, 207, 245}},
      {"Medium High Contrast", {6, 20, 58, 128, 200, 240}},
      {"None", {10, 28, 66, 128, 193, 236}},
      {"Medium Low Contrast", {14, 34, 72, 128, 187, 231}},
      {"Low Contrast", {19, 41, 77, 128, 181, 225}},
      {"Very Low Contrast", {25, 48, 82, 128, 175, 220}}};
  for (const auto& [look, expected] : codes) {
    const DisplayCurve curve(view("Filmic", look), 1.0);
    for (int i = 0; i < 6; ++i) {
      const double light = 0.18 * std::exp2(2.0 * i - 6.0);
      EXPECT_NEAR(curve.code(static_cast<float>(light)), expected[static_cast<std::size_t>(i)],
                  i < 5 ? 5 : 12)
          << look << ' ' << 2 * i - 6;
    }
  }
}

}  // namespace
}  // namespace seedframe
