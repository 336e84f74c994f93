#include "draws/quantile.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <boost/math/special_functions/erf.hpp>
#include <fmt/format.h>

#include "base/portable_math.h"

namespace seedframe::quantile {
namespace {

constexpr double kSqrt2 = 1.41421356237309504880;

// Boost computes both in long double by its default policy, so they are portable as portable_math.h
// asks.
double standard_normal_quantile(double p) { return -kSqrt2 * boost::math::erfc_inv(2.0 * p); }
double standard_normal_cdf(double z) { return 0.5 * boost::math::erfc(-z / kSqrt2); }

}  // namespace

double uniform(double u, double min, double max) { return min + u * (max - min); }

double normal(double u, double mean, double std) {
  return mean + std * standard_normal_quantile(u);
}

double truncated_normal(double u, double mean, double std, double min, double max) {
  if (std == 0.0) return std::clamp(mean, min, max);
  double low = (min - mean) / std;
  double high = (max - mean) / std;
  // Probabilities near 1 have no digits left to tell tails apart; near 0 they have. So an interval
  // in the upper tail is mirrored into the lower one.
  const bool mirrored = low > 0.0;
  if (mirrored) {
    std::swap(low, high);
    low = -low;
    high = -high;
    u = 1.0 - u;
  }
  const double p_low = standard_normal_cdf(low);
  const double p_high = standard_normal_cdf(high);
  const double p = p_low + u * (p_high - p_low);
  // Beyond 38 standard deviations the mass underflows; what is left sits at the nearer end.
  double z = p > 0.0 ? standard_normal_quantile(std::min(p, 1.0 - 1e-16)) : high;
  z = std::clamp(z, low, high);
  return std::clamp(mean + std * (mirrored ? -z : z), min, max);
}

double log_uniform(double u, double min, double max) {
  const double log_min = portable::log(min);
  const double value = portable::exp(log_min + u * (portable::log(max) - log_min));
  return std::clamp(value, min, max);
}

double integer(double u, double min, double max) {
  return std::min(min + std::floor(u * (max - min + 1.0)), max);
}

double poisson(double u, double mean) {
  // The sum of P(k) = e^-m m^k / k!, term by term; long double holds e^-10000.
  long double term = expl(-static_cast<long double>(mean));
  long double sum = term;
  double k = 0.0;
  constexpr double kFarOut = 20000.0;  // rounding may keep the sum below u for ever
  while (sum < u && k < kFarOut) {
    k += 1.0;
    term *= static_cast<long double>(mean) / k;
    sum += term;
  }
  return k;
}

double empirical(double u, std::span<const double> samples) {
  const auto index = static_cast<std::size_t>(u * static_cast<double>(samples.size()));
  return samples[std::min(index, samples.size() - 1)];
}

std::size_t choice(double u, std::span<const double> weights) {
  assert(!weights.empty());
  double total = 0.0;
  for (const double weight : weights) total += weight;
  double left = u * total;
  std::size_t last_possible = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    if (left < weights[i]) return i;
    left -= weights[i];
    last_possible = i;
  }
  return last_possible;
}

std::string weight_error(std::span<const double> weights) {
  double total = 0.0;
  for (const double weight : weights) {
    if (weight < 0.0) return fmt::format("a weight must not be negative, found {}", weight);
    total += weight;
  }
  return total > 0.0 ? std::string() : "all weights are 0: nothing can be chosen";
}

}  // namespace seedframe::quantile
