#include "picture/label_colors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace seedframe {
namespace {

/// Lightness, and the two opponent colours: Ottosson, "A perceptual color space for image
/// processing" (2020).
using Oklab = std::array<double, 3>;

double linear_of(double display) {
  return display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4);
}

double display_of(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

Oklab oklab_of(const DisplayColor& color) {
  const double r = linear_of(color[0]), g = linear_of(color[1]), b = linear_of(color[2]);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

DisplayColor color_of(const Oklab& lab) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2]);
  const double m = cube(lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2]);
  const double s = cube(lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2]);
  return {display_of(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          display_of(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          display_of(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

/// After the palette: hues by the golden angle, so that neighbours are far apart; begun so that the
/// first sixteen are far from the palette and from each other, too.
DisplayColor spread_color(int nth) {
  constexpr double kGoldenAngle = 2.399963229728653;  // pi (3 - sqrt(5))
  constexpr std::array<double, 3> kLightness = {0.66, 0.42, 0.80};
  constexpr double kChroma = 0.15;
  const double hue = 0.6 + kGoldenAngle * nth;
  return color_of({kLightness[static_cast<std::size_t>(nth) % kLightness.size()],
                   kChroma * std::cos(hue), kChroma * std::sin(hue)});
}

}  // namespace

DisplayColor class_color(int category) {
  // Okabe and Ito's ("Color Universal Design", 2008) without black, and a violet.
  static constexpr std::array<DisplayColor, 8> kClassColors = {{{0.90, 0.62, 0.00},
                                                                {0.34, 0.71, 0.91},
                                                                {0.00, 0.62, 0.45},
                                                                {0.94, 0.89, 0.26},
                                                                {0.00, 0.45, 0.70},
                                                                {0.84, 0.37, 0.00},
                                                                {0.80, 0.47, 0.65},
                                                                {0.50, 0.32, 0.78}}};
  constexpr DisplayColor kDistractor = {0.55, 0.55, 0.55};
  if (category <= 0) return kDistractor;
  const auto nth = static_cast<std::size_t>(category) - 1;
  return nth < kClassColors.size() ? kClassColors[nth]
                                   : spread_color(category - 1 - int{kClassColors.size()});
}

DisplayColor instance_color(int category, std::size_t nth) {
  constexpr std::size_t kShades = 5;
  constexpr std::array<double, kShades> kBothWays = {0.0, 0.12, -0.12, 0.06, -0.06};
  constexpr std::array<double, kShades> kDarker = {0.0, -0.24, -0.12, -0.18, -0.06};
  constexpr double kLight = 0.80;  // a lighter shade of such a colour would be white
  Oklab lab = oklab_of(class_color(category));
  if (nth % kShades == 0) return class_color(category);
  lab[0] += (lab[0] > kLight ? kDarker : kBothWays)[nth % kShades];
  return color_of(lab);
}

DisplayColor ink_on(const DisplayColor& background) {
  constexpr double kMiddle = 0.62;  // of lightness
  return oklab_of(background)[0] > kMiddle ? DisplayColor{0.0, 0.0, 0.0}
                                           : DisplayColor{1.0, 1.0, 1.0};
}

DisplayColor depth_color(double share) {
  static constexpr std::array<DisplayColor, 9> kViridis = {{{0.267, 0.005, 0.329},
                                                            {0.278, 0.176, 0.483},
                                                            {0.230, 0.322, 0.546},
                                                            {0.173, 0.449, 0.558},
                                                            {0.128, 0.567, 0.551},
                                                            {0.158, 0.684, 0.502},
                                                            {0.369, 0.789, 0.383},
                                                            {0.678, 0.864, 0.190},
                                                            {0.993, 0.906, 0.144}}};
  const double at = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  const double part = at - static_cast<double>(below);
  DisplayColor color;
  for (std::size_t c = 0; c < color.size(); ++c) {
    color[c] = std::lerp(kViridis[below][c], kViridis[below + 1][c], part);
  }
  return color;
}

std::array<std::uint8_t, 3> color_bytes(const DisplayColor& color) {
  std::array<std::uint8_t, 3> bytes{};
  for (std::size_t c = 0; c < bytes.size(); ++c) {
    bytes[c] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(color[c], 0.0, 1.0)));
  }
  return bytes;
}

}  // namespace seedframe
