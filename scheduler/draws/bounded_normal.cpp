#include "draws/bounded_normal.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <boost/math/quadrature/gauss.hpp>
#include <fmt/format.h>

namespace seedframe {
namespace {

/// exp(-tilt v - bend v^2 / 2) on [low, high], 0 <= bend.
struct Density {
  long double tilt = 0.0L;
  long double bend = 0.0L;
  long double low = 0.0L;
  long double high = 0.0L;

  long double exponent(long double v) const { return -(tilt + 0.5L * bend * v) * v; }
  long double mode() const {
    if (bend > 0.0L) return std::clamp(-tilt / bend, low, high);
    return tilt > 0.0L ? low : high;
  }
};

// exp(-45) is what a long double does not notice beside 1.
constexpr long double kVanished = 45.0L;

/// The part of the range outside of which the density has vanished beside its peak.
Density without_tails(Density density) {
  const long double mode = density.mode();
  // From the mode on, the exponent falls by slope d + bend d^2 / 2 over a distance d.
  const auto reach = [&](long double slope) {
    const long double root = std::sqrt(slope * slope + 2.0L * density.bend * kVanished);
    return 2.0L * kVanished / (slope + root);  // inf where it never falls
  };
  const long double slope = density.tilt + density.bend * mode;  // of -exponent, at the mode
  density.low = std::max(density.low, mode - reach(std::max(-slope, 0.0L)));
  density.high = std::min(density.high, mode + reach(std::max(slope, 0.0L)));
  return density;
}

/// Mass (over that of the peak) and central moments.
struct Moments {
  long double mass = 0.0L;
  long double mean = 0.0L;
  std::array<long double, 5> central{};  ///< [k]: the mean of (v - mean)^k, from k = 2 on
};

constexpr int kPanels = 4;
using Rule = boost::math::quadrature::gauss<long double, 20>;
constexpr int kNodes = 20 * kPanels;

/// Calls visit(v, weight) at the nodes of a composite Gauss-Legendre rule over [low, high].
template <class Visit>
void visit_nodes(long double low, long double high, Visit visit) {
  const long double half = (high - low) / (2 * kPanels);
  for (int panel = 0; panel < kPanels; ++panel) {
    const long double middle = low + half * static_cast<long double>(2 * panel + 1);
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      const long double step = half * Rule::abscissa()[i];
      visit(middle - step, half * Rule::weights()[i]);
      visit(middle + step, half * Rule::weights()[i]);
    }
  }
}

Moments moments_of(const Density& whole) {
  const Density density = without_tails(whole);
  const long double peak = density.exponent(density.mode());
  std::array<long double, kNodes> place{};
  std::array<long double, kNodes> mass{};
  std::size_t count = 0;
  Moments moments;
  visit_nodes(density.low, density.high, [&](long double v, long double weight) {
    place[count] = v;
    mass[count] = weight * expl(density.exponent(v) - peak);
    moments.mass += mass[count];
    moments.mean += mass[count] * v;
    ++count;
  });
  moments.mean /= moments.mass;
  for (std::size_t i = 0; i < count; ++i) {
    const long double off = place[i] - moments.mean;
    long double power = mass[i] * off * off / moments.mass;
    for (std::size_t k = 2; k < moments.central.size(); ++k, power *= off) {
      moments.central[k] += power;
    }
  }
  return moments;
}

constexpr long double kSolved = 1e-16L;  // of what is of the order of 1
constexpr int kMostSteps = 100;

/// Finds the tilt at which the density's mean is 0, which is inside its range. The mean falls with
/// the tilt, by the variance.
Moments center(Density& density) {
  const long double nearest = std::min(-density.low, density.high);
  // An exponential density of this rate, however long its tail, is centred on the nearer end.
  long double least = -1.0L / nearest;
  long double most = 1.0L / nearest;
  Moments moments;
  for (int step = 0; step < kMostSteps; ++step) {
    density.tilt = std::clamp(density.tilt, least, most);
    moments = moments_of(density);
    if (std::fabs(moments.mean) <= kSolved * std::sqrt(moments.central[2])) break;
    (moments.mean > 0.0L ? least : most) = density.tilt;
    const long double next = density.tilt + moments.mean / moments.central[2];
    const long double before = density.tilt;
    density.tilt = next >= least && next <= most ? next : 0.5L * (least + most);
    if (density.tilt == before) break;
  }
  return moments;
}

/// The density with mean 0 and variance 1, whose range is wide enough for one. At mean 0 the
/// variance falls as the bend grows from 0, an exponential density, to 1, where cutting the tails
/// off has made it 1 or less.
Density solve(long double low, long double high) {
  long double least = 0.0L;
  long double most = 1.0L;
  Density density{0.0L, 1.0L, low, high};
  for (int step = 0; step < kMostSteps; ++step) {
    const Moments moments = center(density);
    const auto& m = moments.central;
    const long double excess = m[2] - 1.0L;
    if (std::fabs(excess) <= 10.0L * kSolved) break;
    (excess > 0.0L ? least : most) = density.bend;
    const long double fall = 0.5L * (m[4] - m[2] * m[2] - m[3] * m[3] / m[2]);
    const long double next = density.bend + excess / fall;
    const long double before = density.bend;
    density.bend = next >= least && next <= most ? next : 0.5L * (least + most);
    if (density.bend == before) break;
    density.tilt -= 0.5L * m[3] / m[2] * (density.bend - before);  // keeps the mean, nearly
  }
  return density;
}

long double mass_between(const Density& density, long double low, long double high) {
  const long double peak = density.exponent(density.mode());
  long double mass = 0.0L;
  visit_nodes(low, high, [&](long double v, long double weight) {
    mass += weight * expl(density.exponent(v) - peak);
  });
  return mass;
}

/// How far from the end at `low` (or, if `from_high`, at `high`) the mass is `share` of the whole,
/// at most half: Newton's method on the logarithm of the mass, which is concave.
long double distance_of_share(const Density& density, long double share, bool from_high) {
  const long double length = density.high - density.low;
  const auto mass_within = [&](long double distance) {
    return from_high ? mass_between(density, density.high - distance, density.high)
                     : mass_between(density, density.low, density.low + distance);
  };
  const long double peak = density.exponent(density.mode());
  const long double wanted = share * mass_within(length);
  long double least = 0.0L;
  long double most = length;
  long double distance = 0.5L * length;
  for (int step = 0; step < kMostSteps; ++step) {
    const long double mass = mass_within(distance);
    (mass < wanted ? least : most) = distance;
    const long double at = from_high ? density.high - distance : density.low + distance;
    const long double slope = expl(density.exponent(at) - peak) / mass;
    const long double next = distance - logl(mass / wanted) / slope;
    const long double before = distance;
    distance = next >= least && next <= most ? next : 0.5L * (least + most);
    constexpr long double kNear = 1e-10L;  // the last step squares it
    if (std::fabs(distance - before) <= kNear * distance) break;
  }
  return distance;
}

}  // namespace

double BoundedNormal::std_limit(double mean, double min, double max) {
  const long double below = static_cast<long double>(mean) - min;
  const long double above = static_cast<long double>(max) - mean;
  const long double nearest = std::min(below, above);
  if (!(nearest > 0.0L)) return 0.0;
  Density density{nearest / below - nearest / above, 0.0L, -below / nearest, above / nearest};
  return static_cast<double>(nearest * std::sqrt(center(density).central[2]));
}

std::string BoundedNormal::error(double mean, double std, double min, double max) {
  if (std < 0.0) return fmt::format("bounded_normal needs std >= 0, found {}", std);
  if (min > max) {
    return fmt::format("bounded_normal needs min <= max, found [{}, {}]", min, max);
  }
  if (mean < min || mean > max) {
    return fmt::format("bounded_normal needs a mean from min to max, found {} and [{}, {}]", mean,
                       min, max);
  }
  if (std == 0.0) return {};
  const double limit = std_limit(mean, min, max);
  constexpr double kNearUniform = 1.0 - 1e-9;  // there, rounding decides
  if (std < limit * kNearUniform) return {};
  return fmt::format(
      "no normal distribution within [{}, {}] has mean {} and std {}: with this mean, std must be "
      "below {:.6g}; lower std, widen the range, or move the mean towards the middle, where std "
      "may "
      "be almost {:.6g}",
      min, max, mean, std, limit, (static_cast<long double>(max) - min) / std::sqrt(12.0L));
}

BoundedNormal::BoundedNormal(double mean, double std, double min, double max)
    : mean_(mean), std_(std), min_(min), max_(max) {
  assert(error(mean, std, min, max).empty());
  if (std == 0.0) return;
  const long double scale = std;
  const Density density = without_tails(solve((static_cast<long double>(min) - mean) / scale,
                                              (static_cast<long double>(max) - mean) / scale));
  tilt_ = density.tilt;
  bend_ = density.bend;
  low_ = density.low;
  high_ = density.high;
}

double BoundedNormal::quantile(double u) const {
  if (std_ == 0.0) return mean_;
  const Density density{tilt_, bend_, low_, high_};
  const bool from_high = u > 0.5;
  const long double share = from_high ? 1.0L - u : u;
  const long double distance = distance_of_share(density, share, from_high);
  const long double v = from_high ? high_ - distance : low_ + distance;
  return std::clamp(static_cast<double>(mean_ + std_ * v), min_, max_);
}

double BoundedNormal::share_up_to(double x) const {
  if (std_ == 0.0) return x >= mean_ ? 1.0 : 0.0;
  if (x >= max_) return 1.0;
  const Density density{tilt_, bend_, low_, high_};
  const long double v = std::clamp((static_cast<long double>(x) - mean_) / std_, low_, high_);
  return static_cast<double>(mass_between(density, low_, v) / mass_between(density, low_, high_));
}

}  // namespace seedframe
