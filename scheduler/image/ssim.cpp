#include "image/ssim.h"

#include <cmath>
#include <vector>

#include "image/separable_filter.h"

namespace seedframe {
namespace {

constexpr int kWindow = 11;

std::vector<double> ssim_window() {
  constexpr double kSigma = 1.5;
  std::vector<double> weights(kWindow);
  double sum = 0.0;
  for (int i = 0; i < kWindow; ++i) {
    const int from_center = i - kWindow / 2;
    const double x = from_center / kSigma;
    weights[static_cast<std::size_t>(i)] = std::exp(-0.5 * x * x);
    sum += weights[static_cast<std::size_t>(i)];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

Plane<double> channel_of(const Image<std::uint8_t>& image, std::size_t channel) {
  Plane<double> plane(image.height, image.width);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (Eigen::Index i = 0; i < plane.size(); ++i) {
    plane.data()[i] = image.values[static_cast<std::size_t>(i) * channels + channel];
  }
  return plane;
}

double mean_ssim(const Plane<double>& x, const Plane<double>& y) {
  constexpr double kC1 = 0.01 * 255.0 * 0.01 * 255.0;
  constexpr double kC2 = 0.03 * 255.0 * 0.03 * 255.0;
  const std::vector<double> window = ssim_window();
  const auto local_mean = [&](const Plane<double>& plane) {
    return filtered_columns(filtered_rows(plane, window), window);
  };
  const Plane<double> mean_x = local_mean(x);
  const Plane<double> mean_y = local_mean(y);
  const Plane<double> means = mean_x.square() + mean_y.square();
  const Plane<double> variances = local_mean(x.square() + y.square()) - means;  // of both, summed
  const Plane<double> covariance = local_mean(x * y) - mean_x * mean_y;
  return ((2.0 * mean_x * mean_y + kC1) * (2.0 * covariance + kC2) /
          ((means + kC1) * (variances + kC2)))
      .mean();
}

}  // namespace

std::optional<double> ssim(const Image<std::uint8_t>& rendering,
                           const Image<std::uint8_t>& reference) {
  assert(rendering.width == reference.width && rendering.height == reference.height);
  assert(rendering.channels >= 3 && reference.channels >= 3);
  if (rendering.width < kWindow || rendering.height < kWindow) return std::nullopt;
  double sum = 0.0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    sum += mean_ssim(channel_of(rendering, channel), channel_of(reference, channel));
  }
  return sum / 3.0;
}

}  // namespace seedframe
