// How far the frames of a finished campaign are from what they would be with endless samples.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/run_options.h"
#include "image/rendering_error.h"
#include "quality/promise.h"

namespace seedframe {

struct CheckedFrame {
  std::int64_t frame = 0;
  std::string frame_id;
  std::string pixel_hash;  ///< of what was compared, as the job store has it
  RenderingError error;
};

struct ErrorCheck {
  std::vector<CheckedFrame> frames;  ///< in order
  int reference_samples = 0;         ///< both halves together
  double reference_cpu_s = 0.0;      ///< of one, mean

  std::vector<FrameError> errors_in(const Measure& measure) const;
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

}  // namespace seedframe
