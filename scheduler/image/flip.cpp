#include "image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "image/separable_filter.h"

// The constants are those of the paper that the header names.
namespace seedframe {
namespace {

using Kernel = std::vector<float>;
using Triple = std::array<float, 3>;

/// Linear RGB of sRGB's primaries to XYZ over that of white, (0.31271, 0.32902); and back.
constexpr std::array<Triple, 3> kXyzOfRgb = {Triple{0.4338953888F, 0.3762423726F, 0.1898622385F},
                                             Triple{0.2126368217F, 0.7151829818F, 0.0721801965F},
                                             Triple{0.0177524232F, 0.1094656287F, 0.8727819482F}};
constexpr std::array<Triple, 3> kRgbOfXyz = {Triple{3.0803419883F, -1.5373989695F, -0.5429430188F},
                                             Triple{-0.9211783962F, 1.8759299837F, 0.0452484125F},
                                             Triple{0.0528812929F, -0.2040112061F, 1.1511299132F}};

Triple product(const std::array<Triple, 3>& matrix, const Triple& v) {
  Triple result = {};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = matrix[i][0] * v[0] + matrix[i][1] * v[1] + matrix[i][2] * v[2];
  }
  return result;
}

/// IEC 61966-2-1, for each code.
std::array<float, 256> linear_of_srgb() {
  std::array<float, 256> linear = {};
  for (std::size_t code = 0; code < linear.size(); ++code) {
    const double v = static_cast<double>(code) / 255.0;
    linear[code] =
        static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  }
  return linear;
}

/// Y, X − Y and Y − Z, each over that of white: YCxCz but for factors and an offset,
/// which filters leave alone.
using Opponents = std::array<Plane<float>, 3>;

Opponents opponents_of(const Image<std::uint8_t>& image) {
  static const std::array<float, 256> linear = linear_of_srgb();
  Opponents planes;
  planes.fill(Plane<float>(image.height, image.width));
  const std::uint8_t* pixel = image.values.data();
  for (Eigen::Index i = 0; i < planes[0].size(); ++i, pixel += image.channels) {
    const Triple xyz = product(kXyzOfRgb, {linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]});
    planes[0].data()[i] = xyz[1];
    planes[1].data()[i] = xyz[0] - xyz[1];
    planes[2].data()[i] = xyz[1] - xyz[2];
  }
  return planes;
}

/// Contrast sensitivity as a Gaussian of space: √(π/b) exp(−π² d² / b), d in degrees.
struct Sensitivity {
  double a;
  double b;
};

/// A Gaussian of sum 1, and its weight among those of a channel.
struct WeightedGaussian {
  Kernel kernel;
  float weight = 1.0F;
};

/// The sums of Gaussians of the channels: achromatic, red-green, blue-yellow.
const std::array<std::vector<Sensitivity>, 3>& sensitivities() {
  static const std::array<std::vector<Sensitivity>, 3> table = {{
      {{1.0, 0.0047}},
      {{1.0, 0.0053}},
      {{34.1, 0.04}, {13.5, 0.025}},
  }};
  return table;
}

/// Three standard deviations of the widest, for all of them.
int sensitivity_radius(double pixels_per_degree) {
  constexpr double kWidest = 0.04;
  return static_cast<int>(
      std::ceil(3.0 * std::sqrt(kWidest / 2.0) / std::numbers::pi * pixels_per_degree));
}

std::vector<WeightedGaussian> sensitivity_kernels(const std::vector<Sensitivity>& terms,
                                                  double pixels_per_degree) {
  const int radius = sensitivity_radius(pixels_per_degree);
  std::vector<WeightedGaussian> gaussians;
  std::vector<double> volumes;
  double volume = 0.0;
  for (const Sensitivity& term : terms) {
    std::vector<double> values;
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i) {
      const double degrees = std::numbers::pi * i / pixels_per_degree;
      values.push_back(std::exp(-degrees * degrees / term.b));
      sum += values.back();
    }
    WeightedGaussian& gaussian = gaussians.emplace_back();
    for (const double value : values) gaussian.kernel.push_back(static_cast<float>(value / sum));
    volumes.push_back(term.a * std::sqrt(std::numbers::pi / term.b) * sum * sum);
    volume += volumes.back();
  }
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    gaussians[i].weight = static_cast<float>(volumes[i] / volume);
  }
  return gaussians;
}

/// As the eye blurs them at this distance.
Opponents blurred(const Opponents& opponents, double pixels_per_degree) {
  const int radius = sensitivity_radius(pixels_per_degree);
  Opponents result;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const Plane<float> wide = with_border(opponents[channel], radius);
    Plane<float> sum = Plane<float>::Zero(opponents[channel].rows(), opponents[channel].cols());
    for (const WeightedGaussian& g :
         sensitivity_kernels(sensitivities()[channel], pixels_per_degree)) {
      sum += g.weight * filtered_columns(filtered_rows(wide, g.kernel), g.kernel);
    }
    result[channel] = std::move(sum);
  }
  return result;
}

float lab_root(float t) {
  constexpr float kDelta = 6.0F / 29.0F;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0F * kDelta * kDelta) + 4.0F / 29.0F;
}

/// L*a*b* whose colours fade with their lightness, as Hunt found.
Triple hunt_lab(const Triple& xyz) {
  const Triple root = {lab_root(xyz[0]), lab_root(xyz[1]), lab_root(xyz[2])};
  const float lightness = 116.0F * root[1] - 16.0F;
  return {lightness, 0.01F * lightness * 500.0F * (root[0] - root[1]),
          0.01F * lightness * 200.0F * (root[1] - root[2])};
}

Triple hunt_lab_of_opponents(float y, float x_less_y, float y_less_z) {
  Triple rgb = product(kRgbOfXyz, {y + x_less_y, y, y - y_less_z});
  for (float& channel : rgb) channel = std::clamp(channel, 0.0F, 1.0F);
  return hunt_lab(product(kXyzOfRgb, rgb));
}

/// HyAB (Abasi, Amani Tehran and Fairchild, "Distance Metrics for Very Large Color Differences",
/// 2020) to the power of 0.7.
float color_distance(const Triple& p, const Triple& q) {
  const float a = p[1] - q[1];
  const float b = p[2] - q[2];
  return std::pow(std::abs(p[0] - q[0]) + std::sqrt(a * a + b * b), 0.7F);
}

/// From 0 to 1: the lower 0.4 of all distances get 0.95 of the range.
float remapped(float distance) {
  static const float greatest = color_distance(hunt_lab(product(kXyzOfRgb, {0.0F, 1.0F, 0.0F})),
                                               hunt_lab(product(kXyzOfRgb, {0.0F, 0.0F, 1.0F})));
  constexpr float kRange = 0.95F;
  const float knee = 0.4F * greatest;
  return distance < knee ? kRange / knee * distance
                         : kRange + (distance - knee) / (greatest - knee) * (1.0F - kRange);
}

/// A Gaussian and its first two derivatives in one dimension, so scaled that positive
/// and negative weights sum to 1 and −1; the Gaussian's to 1.
struct FeatureKernels {
  Kernel smooth, edge, point;
};

Kernel balanced(const std::vector<double>& values) {
  double positive = 0.0;
  double negative = 0.0;
  for (const double value : values) (value > 0.0 ? positive : negative) += std::abs(value);
  Kernel kernel;
  for (const double value : values) {
    kernel.push_back(static_cast<float>(value / (value > 0.0 ? positive : negative)));
  }
  return kernel;
}

FeatureKernels feature_kernels(double pixels_per_degree) {
  const double sigma = 0.5 * 0.082 * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> smooth;
  std::vector<double> edge;
  std::vector<double> point;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i / sigma;
    const double gaussian = std::exp(-0.5 * x * x);
    smooth.push_back(gaussian);
    edge.push_back(-x * gaussian);
    point.push_back((x * x - 1.0) * gaussian);
  }
  return {balanced(smooth), balanced(edge), balanced(point)};
}

/// Strengths of edges and of points.
struct Features {
  Plane<float> edges, points;
};

Features features_of(const Plane<float>& luminance, const FeatureKernels& kernels) {
  const int radius = static_cast<int>(kernels.smooth.size() / 2);
  const Plane<float> wide = with_border(luminance, radius);
  const Plane<float> smooth_rows = filtered_rows(wide, kernels.smooth);
  const auto strength = [&](const Kernel& derivative) {
    const Plane<float> across = filtered_columns(filtered_rows(wide, derivative), kernels.smooth);
    const Plane<float> down = filtered_columns(smooth_rows, derivative);
    return Plane<float>((across.square() + down.square()).sqrt());
  };
  return {strength(kernels.edge), strength(kernels.point)};
}

/// The greater of both features' differences, from 0 to 1.
Plane<float> feature_difference(const Features& p, const Features& q) {
  constexpr float kScale = 1.0F / std::numbers::sqrt2_v<float>;
  return (kScale * (p.edges - q.edges).abs().max((p.points - q.points).abs())).sqrt();
}

}  // namespace

double flip_pixels_per_degree() { return 0.7 * 3840.0 / 0.7 * std::numbers::pi / 180.0; }

Image<float> flip_map(const Image<std::uint8_t>& rendering, const Image<std::uint8_t>& reference,
                      double pixels_per_degree) {
  assert(rendering.width == reference.width && rendering.height == reference.height);
  assert(rendering.channels >= 3 && reference.channels >= 3 && pixels_per_degree >= 1.0);
  Image<float> map(reference.width, reference.height, 1);
  if (map.values.empty()) return map;
  const Opponents x = opponents_of(rendering);
  const Opponents r = opponents_of(reference);
  const FeatureKernels kernels = feature_kernels(pixels_per_degree);
  const Plane<float> features =
      feature_difference(features_of(x[0], kernels), features_of(r[0], kernels));
  const Opponents seen_x = blurred(x, pixels_per_degree);
  const Opponents seen_r = blurred(r, pixels_per_degree);
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const auto lab = [i](const Opponents& seen) {
      return hunt_lab_of_opponents(seen[0].data()[i], seen[1].data()[i], seen[2].data()[i]);
    };
    const float color = remapped(color_distance(lab(seen_x), lab(seen_r)));
    map.values[i] = std::pow(color, 1.0F - features.data()[i]);
  }
  return map;
}

double mean_flip(const Image<float>& map) {
  if (map.values.empty()) return 0.0;
  double sum = 0.0;
  for (const float value : map.values) sum += value;
  return sum / static_cast<double>(map.values.size());
}

}  // namespace seedframe
