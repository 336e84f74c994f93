// How far the frames of a finished campaign are from what they would be with endless samples.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/run_options.h"
#include "image/rendering_error.h"
#include "quality/measure.h"

namespace seedframe {

struct CheckedFrame {
  std::int64_t frame = 0;
  RenderingError error;
};

struct ErrorCheck {
  std::vector<CheckedFrame> frames;  ///< in order
  int reference_samples = 0;         ///< both halves together
  double reference_cpu_s = 0.0;      ///< of one, mean
};

/// Which of the frames that are done to look at: `count` strata of equal size, in order, and one
/// frame of each, drawn by `seed`. All if there are no more.
std::vector<std::int64_t> stratified_sample(const std::vector<std::int64_t>& done, int count,
                                            std::uint64_t seed);

struct CheckWishes {
  std::vector<std::int64_t> frames;
  int reference_samples = 1024;
};

/// Renders references of these frames beside the campaign, which is only read, and compares what it
/// has with them. `prepared` is of the campaign's own source. kCorrupt: a frame's file is not there
/// or not readable; kInput: a frame that is not done, or that would be another one today.
Result<ErrorCheck> check_errors(const Campaign& campaign, const PreparedCampaign& prepared,
                                const RunSetup& setup, const CheckWishes& wishes,
                                const std::filesystem::path& scratch,
                                const std::function<void(std::int64_t frame)>& on_rendering);

/// A share of all, told by a sample of them: with the interval in which it lies with 95 %
/// confidence (Wilson, "Probable Inference, the Law of Succession, and Statistical Inference",
/// 1927).
struct EstimatedShare {
  double value = 0.0;
  double least = 0.0;
  double most = 1.0;
};
EstimatedShare estimate_share(int within, int of);

/// What is promised of a campaign: so many of its frames are at most so wrong.
struct ErrorPromise {
  const Measure* measure = nullptr;
  double max_error = 0.0;
  double share = 0.95;  ///< of the frames
};

struct PromiseCheck {
  EstimatedShare within;
  std::vector<std::int64_t> beyond;  ///< frames
  bool is_kept = false;              ///< the share of the sample is the promised one or more
};
PromiseCheck check_promise(const ErrorCheck& check, const ErrorPromise& promise);

/// Least error that so many of the frames do not exceed, `share` from 0 to 1: the nearest rank.
double quantile_of_error(const ErrorCheck& check, const Measure& measure, double share);

}  // namespace seedframe
