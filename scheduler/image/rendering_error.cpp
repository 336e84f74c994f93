#include "image/rendering_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/flip.h"
#include "image/luminance.h"
#include "image/ssim.h"

namespace seedframe {
namespace {

using Rgb3 = std::array<double, 3>;

Rgb3 rgb_of(const float* pixel) { return {pixel[0], pixel[1], pixel[2]}; }

bool all_finite(const Rgb3& rgb) {
  return std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]);
}

/// Of the squares of `difference`, weighted as the reference's pixel says.
void add_squares(SquaredErrors& sums, const Rgb3& difference, const Rgb3& reference) {
  const double gray = std::max(0.0, (reference[0] + reference[1] + reference[2]) / 3.0) + 0.01;
  for (std::size_t c = 0; c < 3; ++c) {
    const double square = difference[c] * difference[c];
    sums.mse += square;
    sums.rel_mse += square / (reference[c] * reference[c] + 0.01);
    sums.mrse += square / (gray * gray);
  }
}

SquaredErrors scaled(const SquaredErrors& errors, double factor) {
  return {errors.mse * factor, errors.rel_mse * factor, errors.mrse * factor};
}

template <class T>
bool are_alike(const Image<T>& a, const Image<T>& b) {
  return a.width == b.width && a.height == b.height && a.channels >= 3 && b.channels >= 3;
}

/// Calls `visit` with the pixel's first value in both.
template <class T, class Visit>
void for_each_pixel(const Image<T>& a, const Image<T>& b, Visit visit) {
  assert(are_alike(a, b));
  const T* x = a.values.data();
  const T* y = b.values.data();
  const std::int64_t pixels = std::int64_t{a.width} * a.height;
  for (std::int64_t i = 0; i < pixels; ++i) visit(x + i * a.channels, y + i * b.channels);
}

/// Sums over pixels, of three values each.
struct CodeSums {
  std::int64_t pixels = 0;
  std::int64_t differences = 0;
  std::int64_t squares = 0;

  double mean_of_values(std::int64_t sum) const {
    return pixels > 0 ? static_cast<double>(sum) / (3.0 * static_cast<double>(pixels)) : 0.0;
  }
};

CodeSums code_sums(const Image<std::uint8_t>& rendering, const Image<std::uint8_t>& reference) {
  CodeSums sums;
  for_each_pixel(rendering, reference, [&](const std::uint8_t* x, const std::uint8_t* r) {
    ++sums.pixels;
    for (int c = 0; c < 3; ++c) {
      const int difference = x[c] - r[c];
      sums.differences += difference;
      sums.squares += difference * difference;
    }
  });
  return sums;
}

}  // namespace

double SquaredErrors::rmse() const { return std::sqrt(mse); }
double DisplayError::rmse() const { return std::sqrt(mse); }
double DisplayError::psnr_db() const {
  return mse > 0.0 ? 10.0 * std::log10(255.0 * 255.0 / mse)
                   : std::numeric_limits<double>::infinity();
}

LinearError linear_error(const Image<float>& rendering, const Image<float>& reference) {
  LinearError error;
  SquaredErrors sums;
  Rgb3 differences = {};
  double luminance_of_reference = 0.0;
  for_each_pixel(rendering, reference, [&](const float* x_pixel, const float* r_pixel) {
    const Rgb3 x = rgb_of(x_pixel);
    const Rgb3 r = rgb_of(r_pixel);
    if (!all_finite(x) || !all_finite(r)) {
      ++error.not_finite;
      return;
    }
    ++error.pixels;
    const Rgb3 difference = {x[0] - r[0], x[1] - r[1], x[2] - r[2]};
    add_squares(sums, difference, r);
    for (std::size_t c = 0; c < 3; ++c) differences[c] += difference[c];
    luminance_of_reference += luminance(r[0], r[1], r[2]);
  });
  if (error.pixels == 0) return error;
  const auto pixels = static_cast<double>(error.pixels);
  error.squared = scaled(sums, 1.0 / (3.0 * pixels));
  for (std::size_t c = 0; c < 3; ++c) error.bias[c] = differences[c] / pixels;
  const double excess = luminance(differences[0], differences[1], differences[2]);
  if (excess != 0.0) error.luminance_bias = excess / luminance_of_reference;
  return error;
}

DisplayError display_error(const Image<std::uint8_t>& rendering,
                           const Image<std::uint8_t>& reference) {
  const CodeSums sums = code_sums(rendering, reference);
  DisplayError error;
  error.pixels = sums.pixels;
  error.mse = sums.mean_of_values(sums.squares);
  error.bias = sums.mean_of_values(sums.differences);
  error.ssim = ssim(rendering, reference);
  error.flip = mean_flip(flip_map(rendering, reference));
  return error;
}

RenderingError rendering_error(const Picture& rendering, const Picture& reference,
                               const Image<std::uint16_t>& ids) {
  return {linear_error(rendering.linear, reference.linear),
          display_error(rendering.display, reference.display),
          edge_error(rendering.display, reference.display, ids)};
}

Image<float> mean_of(const Image<float>& half_a, const Image<float>& half_b) {
  assert(half_a.width == half_b.width && half_a.height == half_b.height &&
         half_a.channels == half_b.channels);
  Image<float> mean(half_a.width, half_a.height, half_a.channels);
  for (std::size_t i = 0; i < mean.values.size(); ++i) {
    mean.values[i] =
        static_cast<float>((double{half_a.values[i]} + double{half_b.values[i]}) / 2.0);
  }
  return mean;
}

SquaredErrors linear_variance(const Image<float>& half_a, const Image<float>& half_b) {
  SquaredErrors sums;
  std::int64_t pixels = 0;
  for_each_pixel(half_a, half_b, [&](const float* a_pixel, const float* b_pixel) {
    const Rgb3 a = rgb_of(a_pixel);
    const Rgb3 b = rgb_of(b_pixel);
    if (!all_finite(a) || !all_finite(b)) return;
    ++pixels;
    add_squares(sums, {a[0] - b[0], a[1] - b[1], a[2] - b[2]},
                {(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0, (a[2] + b[2]) / 2.0});
  });
  return pixels > 0 ? scaled(sums, 1.0 / (4.0 * 3.0 * static_cast<double>(pixels))) : sums;
}

double display_variance(const Image<std::uint8_t>& half_a, const Image<std::uint8_t>& half_b) {
  const CodeSums sums = code_sums(half_a, half_b);
  return sums.mean_of_values(sums.squares) / 4.0;
}

ReferenceVariance reference_variance(const Picture& half_a, const Picture& half_b,
                                     const Image<std::uint16_t>& ids) {
  return {linear_variance(half_a.linear, half_b.linear),
          display_variance(half_a.display, half_b.display),
          edge_error(half_a.display, half_b.display, ids).mean_square / 4.0};
}

double without_variance(double measured, double variance) {
  return std::max(0.0, measured - variance);
}

SquaredErrors without_variance(const SquaredErrors& measured, const SquaredErrors& variance) {
  return {without_variance(measured.mse, variance.mse),
          without_variance(measured.rel_mse, variance.rel_mse),
          without_variance(measured.mrse, variance.mrse)};
}

RenderingError without_variance(const RenderingError& measured, const ReferenceVariance& variance) {
  RenderingError error = measured;
  error.linear.squared = without_variance(measured.linear.squared, variance.linear);
  error.display.mse = without_variance(measured.display.mse, variance.display);
  error.edges.mean_square = without_variance(measured.edges.mean_square, variance.edges);
  return error;
}

}  // namespace seedframe
