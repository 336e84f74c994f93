#include "preview/texture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "preview/linear_image.h"

namespace seedframe {
namespace {

using Eigen::Vector3f;

Image<std::uint8_t> coded(const Image<float>& light) {
  Image<std::uint8_t> codes(light.width, light.height, 3);
  std::transform(light.values.begin(), light.values.end(), codes.values.begin(), srgb_code);
  return codes;
}

/// Each pixel the mean of two (at the end of odd numbers: three) a side.
Image<float> halved(const Image<float>& light) {
  Image<float> half(std::max(1, light.width / 2), std::max(1, light.height / 2), 3);
  for (int row = 0; row < half.height; ++row) {
    const int top = row * light.height / half.height;
    const int bottom = (row + 1) * light.height / half.height;
    for (int column = 0; column < half.width; ++column) {
      const int left = column * light.width / half.width;
      const int right = (column + 1) * light.width / half.width;
      Vector3f sum = Vector3f::Zero();
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) sum += Eigen::Map<const Vector3f>(&light.at(y, x));
      }
      Eigen::Map<Vector3f>(&half.at(row, column)) =
          sum / static_cast<float>((bottom - top) * (right - left));
    }
  }
  return half;
}

using Lights = std::array<float, 256>;

Vector3f light_at(const Image<std::uint8_t>& level, int row, int column, const Lights& lights) {
  const std::uint8_t* code = &level.at(row, column);
  return {lights[code[0]], lights[code[1]], lights[code[2]]};
}

/// The pixels before and behind a place, round about, and how near it is to the one behind.
struct Between {
  int before = 0, behind = 0;
  float share = 0.0F;
};

Between between(double share_of_image, int pixels) {
  const double at = (share_of_image - std::floor(share_of_image)) * pixels - 0.5;
  const double whole = std::floor(at);
  const int before = (static_cast<int>(whole) + pixels) % pixels;
  return {before, (before + 1) % pixels, static_cast<float>(at - whole)};
}

}  // namespace

Texture::Texture(Image<float> light) {
  assert(light.width > 0 && light.height > 0 && light.channels == 3);
  levels_.push_back(coded(light));
  while (light.width > 1 || light.height > 1) {
    light = halved(light);
    levels_.push_back(coded(light));
  }
  mean_ = Eigen::Map<const Vector3f>(light.values.data());
}

Vector3f Texture::color(double u, double v, double width) const {
  const Image<std::uint8_t>& whole = levels_.front();
  const double pixels = width * std::sqrt(static_cast<double>(whole.width) * whole.height);
  const auto last = static_cast<double>(levels_.size() - 1);
  const double level = std::isfinite(pixels) && pixels > 1.0 ? std::log2(pixels) : 0.0;
  if (level >= last) return mean_;
  const auto finer = static_cast<std::size_t>(level);
  const auto share = static_cast<float>(level - static_cast<double>(finer));
  Vector3f fine = in_level(finer, u, v);
  if (share == 0.0F) return fine;
  return (1.0F - share) * fine + share * in_level(finer + 1, u, v);
}

Vector3f Texture::in_level(std::size_t level, double u, double v) const {
  const Image<std::uint8_t>& image = levels_[level];
  const Lights& lights = srgb_lights();
  const Between x = between(u, image.width);
  const Between y = between(1.0 - v, image.height);
  const Vector3f upper = (1.0F - x.share) * light_at(image, y.before, x.before, lights) +
                         x.share * light_at(image, y.before, x.behind, lights);
  const Vector3f lower = (1.0F - x.share) * light_at(image, y.behind, x.before, lights) +
                         x.share * light_at(image, y.behind, x.behind, lights);
  return (1.0F - y.share) * upper + y.share * lower;
}

std::size_t Texture::bytes() const {
  std::size_t sum = sizeof *this;
  for (const Image<std::uint8_t>& level : levels_) sum += level.values.size();
  return sum;
}

}  // namespace seedframe
