#include "quality/promise.h"

#include <algorithm>
#include <cmath>

namespace seedframe {

EstimatedShare estimate_share(int within, int of) {
  if (of == 0) return {};
  constexpr double kZ = 1.959963984540054;  // of 95 %
  const double n = of;
  const double p = within / n;
  const double center = (p + kZ * kZ / (2.0 * n)) / (1.0 + kZ * kZ / n);
  const double half =
      kZ / (1.0 + kZ * kZ / n) * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n));
  return {p, std::max(0.0, center - half), std::min(1.0, center + half)};
}

ErrorPromise promise_of(const QualityWish& wish) {
  const ErrorBound bound = error_bound(wish);
  return {&measure_named(kQualityMetricNames[static_cast<std::size_t>(bound.metric)]),
          bound.max_error, wish.share};
}

PromiseCheck check_promise(const std::vector<FrameError>& errors, const ErrorPromise& promise) {
  PromiseCheck result;
  for (const FrameError& each : errors) {
    if (!promise.allows(each.error)) result.beyond.push_back(each.frame);
  }
  const auto all = static_cast<int>(errors.size());
  result.within = estimate_share(all - static_cast<int>(result.beyond.size()), all);
  result.is_kept = all > 0 && result.within.value >= promise.share;
  return result;
}

double quantile_of_error(const std::vector<FrameError>& errors, double share) {
  if (errors.empty()) return 0.0;
  std::vector<double> sorted;
  sorted.reserve(errors.size());
  for (const FrameError& each : errors) sorted.push_back(each.error);
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  const auto index = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
  return sorted[std::min(index, sorted.size() - 1)];
}

}  // namespace seedframe
