#include "picture/pixel_scaling.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

namespace seedframe {
namespace {

const std::array<float, 256>& linear_light() {
  static const std::array<float, 256> light_by_code = [] {
    std::array<float, 256> table{};
    for (std::size_t code = 0; code < table.size(); ++code) {
      const double display = static_cast<double>(code) / 255.0;
      table[code] = static_cast<float>(
          display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4));
    }
    return table;
  }();
  return light_by_code;
}

/// The code whose light is nearest: between the middles of its neighbours.
std::uint8_t code_of(float light) {
  static const std::array<float, 255> middle_light = [] {
    std::array<float, 255> middles{};
    for (std::size_t code = 0; code < middles.size(); ++code) {
      middles[code] = 0.5F * (linear_light()[code] + linear_light()[code + 1]);
    }
    return middles;
  }();
  const auto above = std::upper_bound(middle_light.begin(), middle_light.end(), light);
  return static_cast<std::uint8_t>(above - middle_light.begin());
}

/// A pixel of the shrunken image along one axis: how much of which pixels it covers.
struct Cover {
  int first = 0;
  std::vector<float> weights;  ///< they add up to 1
};

std::vector<Cover> covers_of(int from, int to) {
  std::vector<Cover> covers(static_cast<std::size_t>(to));
  const double step = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    Cover& cover = covers[static_cast<std::size_t>(i)];
    const double begin = i * step, end = std::min<double>(from, (i + 1) * step);
    cover.first = static_cast<int>(begin);
    for (int pixel = cover.first; pixel < end; ++pixel) {
      const double part = std::min<double>(end, pixel + 1.0) - std::max<double>(begin, pixel);
      cover.weights.push_back(static_cast<float>(part / (end - begin)));
    }
  }
  return covers;
}

/// Rows of `values` (three channels), each narrowed.
void narrow(const Image<std::uint8_t>& image, int row, const std::vector<Cover>& columns,
            std::vector<float>& out) {
  const std::array<float, 256>& light = linear_light();
  std::fill(out.begin(), out.end(), 0.0F);
  auto to = out.begin();
  for (const Cover& cover : columns) {
    const std::uint8_t* from = &image.at(row, cover.first);
    for (const float weight : cover.weights) {
      for (std::ptrdiff_t c = 0; c < 3; ++c) to[c] += weight * light[*from++];
    }
    to += 3;
  }
}

}  // namespace

Image<std::uint8_t> shrunk(const Image<std::uint8_t>& image, int width, int height) {
  assert(image.channels == 3 && width > 0 && height > 0);
  assert(width <= image.width && height <= image.height);
  if (width == image.width && height == image.height) return image;
  const std::vector<Cover> columns = covers_of(image.width, width);
  const std::vector<Cover> rows = covers_of(image.height, height);
  Image<std::uint8_t> out(width, height, 3);
  std::vector<float> narrowed(3 * static_cast<std::size_t>(width)), sum(narrowed.size());
  auto value = out.values.begin();
  for (const Cover& cover : rows) {
    std::fill(sum.begin(), sum.end(), 0.0F);
    for (std::size_t i = 0; i < cover.weights.size(); ++i) {
      narrow(image, cover.first + static_cast<int>(i), columns, narrowed);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += cover.weights[i] * narrowed[k];
    }
    value = std::transform(sum.begin(), sum.end(), value, code_of);
  }
  return out;
}

Image<std::uint8_t> enlarged(const Image<std::uint8_t>& image, int factor) {
  assert(factor >= 1);
  if (factor == 1) return image;
  Image<std::uint8_t> out(factor * image.width, factor * image.height, image.channels);
  const auto row_values = static_cast<std::ptrdiff_t>(out.width) * out.channels;
  for (int row = 0; row < image.height; ++row) {
    std::uint8_t* const begin = &out.at(factor * row, 0);
    std::uint8_t* to = begin;
    for (int column = 0; column < image.width; ++column) {
      const std::uint8_t* from = &image.at(row, column);
      for (int i = 0; i < factor; ++i) to = std::copy(from, from + image.channels, to);
    }
    for (int i = 1; i < factor; ++i) std::copy(begin, begin + row_values, begin + i * row_values);
  }
  return out;
}

}  // namespace seedframe
