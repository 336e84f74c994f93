// What is promised of the errors of a campaign's frames, and whether a sample of them keeps it.
#pragma once

#include <cstdint>
#include <vector>

#include "quality/measure.h"
#include "spec/quality_wish.h"

namespace seedframe {

/// In one measure; NaN is beyond any bound.
struct FrameError {
  std::int64_t frame = 0;
  double error = 0.0;
};

/// A share of all, told by a sample of them: with the interval in which it lies with 95 %
/// confidence (Wilson, "Probable Inference, the Law of Succession, and Statistical Inference",
/// 1927).
struct EstimatedShare {
  double value = 0.0;
  double least = 0.0;
  double most = 1.0;
};
EstimatedShare estimate_share(int within, int of);

/// So many of the campaign's frames are at most so wrong.
struct ErrorPromise {
  const Measure* measure = nullptr;
  double max_error = 0.0;
  double share = 0.95;  ///< of the frames

  bool allows(double error) const { return error <= max_error; }
};
ErrorPromise promise_of(const QualityWish& wish);

struct PromiseCheck {
  EstimatedShare within;
  std::vector<std::int64_t> beyond;  ///< frames
  bool is_kept = false;              ///< the share of the sample is the promised one or more
};
PromiseCheck check_promise(const std::vector<FrameError>& errors, const ErrorPromise& promise);

/// Least error that so many of the frames do not exceed, `share` from 0 to 1: the nearest rank.
double quantile_of_error(const std::vector<FrameError>& errors, double share);

}  // namespace seedframe
