// Tests of samples against a distribution: how probable is a sample at least this odd?
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <gtest/gtest.h>

namespace seedframe {

/// The seeds of the tests are fixed, so a p-value below this is no bad luck but a mistake.
inline constexpr double kLeastP = 1e-4;

/// The largest distance between the samples' distribution function and `cdf`.
inline double kolmogorov_distance(std::vector<double> samples,
                                  const std::function<double(double)>& cdf) {
  std::sort(samples.begin(), samples.end());
  const auto n = static_cast<double>(samples.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double p = cdf(samples[i]);
    distance =
        std::max({distance, static_cast<double>(i + 1) / n - p, p - static_cast<double>(i) / n});
  }
  return distance;
}

/// P(D ≥ distance) of the Kolmogorov–Smirnov test: Kolmogorov's series with the correction for
/// finite n of M. A. Stephens (J. R. Stat. Soc. B 32, 1970), good to three digits from n = 100 on.
inline double kolmogorov_p(double distance, std::size_t count) {
  const double root = std::sqrt(static_cast<double>(count));
  const double x = (root + 0.12 + 0.11 / root) * distance;
  if (x < 0.2) return 1.0;  // the series converges too slowly there, and the answer is known
  double p = 0.0;
  for (int k = 1; k <= 100; ++k) {
    p += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  }
  return std::clamp(p, 0.0, 1.0);
}

inline double kolmogorov_p(const std::vector<double>& samples,
                           const std::function<double(double)>& cdf) {
  return kolmogorov_p(kolmogorov_distance(samples, cdf), samples.size());
}

/// Pearson's test of counts against what was expected of each, which should be 5 or more.
inline double chi_squared_p(const std::vector<double>& counts,
                            const std::vector<double>& expected) {
  EXPECT_EQ(counts.size(), expected.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    EXPECT_GE(expected[i], 5.0);
    sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  }
  const boost::math::chi_squared distribution(static_cast<double>(counts.size()) - 1.0);
  return boost::math::cdf(boost::math::complement(distribution, sum));
}

inline double mean_of(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

/// Pearson's.
inline double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const double mean_x = mean_of(x);
  const double mean_y = mean_of(y);
  double xy = 0.0;
  double xx = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  return xy / std::sqrt(xx * yy);
}

/// P(|r| ≥ that) of independent pairs, by Fisher's z.
inline double independence_p(const std::vector<double>& x, const std::vector<double>& y) {
  EXPECT_EQ(x.size(), y.size());
  const double z = std::atanh(correlation(x, y)) * std::sqrt(static_cast<double>(x.size()) - 3.0);
  return 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), std::fabs(z)));
}

}  // namespace seedframe
