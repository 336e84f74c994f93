#include "formula/color.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"

namespace seedframe {
namespace {

double decode_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : portable::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace

Rgb linear_from_hsv(double hue_deg, double saturation, double value) {
  const double sector = (hue_deg - 360.0 * std::floor(hue_deg / 360.0)) / 60.0;
  Rgb rgb{};
  constexpr std::array<double, 3> kPhase = {5.0, 3.0, 1.0};
  for (std::size_t i = 0; i < 3; ++i) {
    double k = kPhase[i] + sector;
    if (k >= 6.0) k -= 6.0;
    const double ramp = std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
    rgb[i] = decode_srgb(value - value * saturation * ramp);
  }
  return rgb;
}

Rgb linear_from_kelvin(double kelvin) {
  const double t = std::clamp(kelvin, 1667.0, 25000.0);
  const double i = 1e3 / t;
  const double x = t < 4000.0 ? ((-0.2661239 * i - 0.2343589) * i + 0.8776956) * i + 0.179910
                              : ((-3.0258469 * i + 2.1070379) * i + 0.2226347) * i + 0.240390;
  double y = 0.0;
  if (t < 2222.0) {
    y = ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683;
  } else if (t < 4000.0) {
    y = ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
  } else {
    y = ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
  }
  // xyY with Y = 1 to XYZ, then to linear Rec.709 (IEC 61966-2-1).
  const double big_x = x / y;
  const double big_z = (1.0 - x - y) / y;
  Rgb rgb = {3.2404542 * big_x - 1.5371385 - 0.4985314 * big_z,
             -0.9692660 * big_x + 1.8760108 + 0.0415560 * big_z,
             0.0556434 * big_x - 0.2040259 + 1.0572252 * big_z};
  for (double& c : rgb) c = std::max(c, 0.0);
  const double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  for (double& c : rgb) c /= luminance;
  return rgb;
}

}  // namespace seedframe
