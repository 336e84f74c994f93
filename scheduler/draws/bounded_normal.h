// The truncated normal distribution with a given mean and standard deviation of its own.
#pragma once

#include <string>

namespace seedframe {

/// Of all densities on [min, max] that are a piece of a normal one, the one whose mean and standard
/// deviation are those asked for; those of the whole normal are then others. It is the density of
/// most entropy with these moments (E. T. Jaynes, Phys. Rev. 106, 1957), so there is one at most.
///
/// Immutable; results are the same on every machine (long double and expl only, as in
/// base/portable_math.h).
class BoundedNormal {
 public:
  /// What keeps a normal distribution from having this mean and this standard deviation within
  /// [min, max], with numbers and what to do, in a sentence; empty if nothing does. All arguments
  /// are finite.
  static std::string error(double mean, double std, double min, double max);

  /// The standard deviation below which there is a distribution of this mean: that of the truncated
  /// exponential distribution; of the uniform one in the middle. 0 at min and max.
  static double std_limit(double mean, double min, double max);

  /// Only where error() is empty.
  BoundedNormal(double mean, double std, double min, double max);

  /// Rises from min to max with u in (0, 1).
  double quantile(double u) const;
  /// P(X <= x).
  double share_up_to(double x) const;

 private:
  double mean_, std_, min_, max_;
  // Of v = (x - mean) / std the density is proportional to exp(-tilt v - bend v^2 / 2) on
  // [low, high]: the ends of the range, or where nothing is left of the density.
  long double tilt_ = 0.0L;
  long double bend_ = 1.0L;
  long double low_ = 0.0L;
  long double high_ = 0.0L;
};

}  // namespace seedframe
