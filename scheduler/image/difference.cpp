#include "image/difference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <Imath/half.h>

namespace seedframe {
namespace {

/// Neighbours among the numbers of a type are neighbours among these.
std::int64_t place_among_floats(float value) {
  const auto bits = std::bit_cast<std::int32_t>(value);
  return bits >= 0 ? bits : std::numeric_limits<std::int32_t>::min() - std::int64_t{bits};
}
std::int64_t place_among_halves(float value) {
  const auto bits = static_cast<std::int16_t>(Imath::half(value).bits());
  return bits >= 0 ? bits : std::numeric_limits<std::int16_t>::min() - std::int64_t{bits};
}

bool differ(float a, float b) { return a != b && !(std::isnan(a) && std::isnan(b)); }

/// `Steps` counts those between two values.
template <class T, class Steps>
ImageDifference difference_by(const Image<T>& a, const Image<T>& b, Steps steps) {
  assert(a.width == b.width && a.height == b.height && a.channels == b.channels);
  ImageDifference difference;
  const auto channels = static_cast<std::size_t>(a.channels);
  difference.pixels = static_cast<std::int64_t>(a.values.size() / channels);
  long double squares = 0.0L;
  for (std::size_t pixel = 0; pixel < a.values.size(); pixel += channels) {
    bool any = false;
    for (std::size_t i = pixel; i < pixel + channels; ++i) {
      const auto x = static_cast<float>(a.values[i]);
      const auto y = static_cast<float>(b.values[i]);
      if (!differ(x, y)) continue;
      any = true;
      const double distance = std::isnan(x) || std::isnan(y)
                                  ? std::numeric_limits<double>::infinity()
                                  : std::abs(double{x} - double{y});
      difference.max = std::max(difference.max, distance);
      squares += static_cast<long double>(distance) * static_cast<long double>(distance);
      difference.max_ulp = std::max<std::int64_t>(difference.max_ulp, steps(x, y));
    }
    if (any) ++difference.differing;
  }
  if (!a.values.empty()) {
    difference.rms =
        static_cast<double>(std::sqrt(squares / static_cast<long double>(a.values.size())));
  }
  return difference;
}

/// Blue, green, red for 0, ½, 1.
std::array<double, 3> heat(double value) {
  return {std::clamp(2.0 * value - 1.0, 0.0, 1.0), 1.0 - std::abs(2.0 * value - 1.0),
          std::clamp(1.0 - 2.0 * value, 0.0, 1.0)};
}

}  // namespace

double ImageDifference::psnr_db(double peak) const {
  return rms > 0.0 ? 20.0 * std::log10(peak / rms) : std::numeric_limits<double>::infinity();
}

ImageDifference difference_of(const Image<float>& a, const Image<float>& b, StoredAs stored) {
  if (stored == StoredAs::kHalf) {
    return difference_by(a, b, [](float x, float y) {
      return std::abs(place_among_halves(x) - place_among_halves(y));
    });
  }
  return difference_by(a, b, [](float x, float y) {
    return std::abs(place_among_floats(x) - place_among_floats(y));
  });
}

ImageDifference difference_of(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b) {
  return difference_by(a, b, [](float x, float y) { return std::lround(std::abs(x - y)); });
}

ImageDifference difference_of(const Image<std::uint16_t>& a, const Image<std::uint16_t>& b) {
  return difference_by(a, b, [](float x, float y) { return std::lround(std::abs(x - y)); });
}

Image<std::uint8_t> heat_map(const Image<float>& a, const Image<float>& b) {
  assert(a.width == b.width && a.height == b.height && a.channels == b.channels);
  constexpr double kLeast = 1e-5;  // about the last bit of a dark half
  constexpr double kMost = 0.1;
  constexpr double kDarkened = 0.4;
  constexpr double kLeastHeat = 0.35;  // so that the faintest difference is seen
  Image<std::uint8_t> map(a.width, a.height, 3);
  const int colors = std::min(a.channels, 3);
  for (int row = 0; row < a.height; ++row) {
    for (int column = 0; column < a.width; ++column) {
      double grey = 0.0;
      double distance = 0.0;
      for (int c = 0; c < colors; ++c) {
        const float x = a.at(row, column, c);
        const float y = b.at(row, column, c);
        if (std::isfinite(x)) grey += std::clamp(double{x}, 0.0, 1.0) / colors;
        if (differ(x, y)) distance = std::max(distance, std::abs(double{x} - double{y}));
        if (std::isnan(x) != std::isnan(y)) distance = kMost;
      }
      std::array<double, 3> rgb = {};
      rgb.fill(kDarkened * std::sqrt(grey));
      if (distance > 0.0) {
        const double scale = std::log(distance / kLeast) / std::log(kMost / kLeast);
        rgb = heat(std::clamp(scale, 0.0, 1.0));
        for (double& channel : rgb) channel = kLeastHeat + (1.0 - kLeastHeat) * channel;
      }
      for (int c = 0; c < 3; ++c) {
        map.at(row, column, c) =
            static_cast<std::uint8_t>(std::lround(255.0 * rgb[static_cast<std::size_t>(c)]));
      }
    }
  }
  return map;
}

}  // namespace seedframe
