#include "quality/setting_steps.h"

#include <cmath>

namespace seedframe {

int rounded_samples(double samples) {
  const double least = samples * (1.0 - 1e-9);
  for (int power = 1;; power *= 2) {
    const int between = power + power / 2;  // of 1: 1
    if (power >= least) return power;
    if (between >= least) return between;
  }
}

double rounded_threshold(double threshold) {
  constexpr double kSteps = 4.0;
  constexpr double kDigits = 1e5;
  constexpr double kRounding = 0.03;  // of a step: what rounding to digits moves the finest by
  const double steps = std::ceil(kSteps * std::log2(kCoarsestThreshold / threshold) - kRounding);
  return std::round(kCoarsestThreshold * std::exp2(-steps / kSteps) * kDigits) / kDigits;
}

}  // namespace seedframe
