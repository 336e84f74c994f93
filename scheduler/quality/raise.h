// More samples for frames that were measured to be further from their references than is promised.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "quality/promise.h"
#include "scene/prepared_campaign.h"
#include "spec/quality_wish.h"

namespace seedframe {

/// What a frame is rendered with next that had such an error, above the bound, with `choice`. How
/// errors fall is from results/error_vs_time: those of plain samples with the root of their number,
/// denoised ones with its fourth root, adaptive ones with the threshold to the power of 0.4,
/// and where pixels stop at the first look as plain ones do: both are changed. A tenth is added to
/// what was measured. A frame that would need more than `most_samples` has so many, plain ones.
/// Nothing: it had these.
std::optional<RenderChoice> raised_choice(const RenderChoice& choice, double error,
                                          const ErrorBound& bound, int most_samples);

/// "16 samples", "adaptive sampling to 0.1, at least 16 samples", "4 samples, denoised".
std::string describe(const RenderChoice& choice);

struct Raise {
  std::int64_t frame = 0;
  double error = 0.0;  ///< that was measured
  RenderChoice from;
  RenderChoice to;
};

struct RaisePlan {
  ErrorPromise promise;
  std::vector<Raise> raises;              ///< in the order of frames
  std::vector<FrameError> at_their_most;  ///< beyond the bound, with all render.samples
};

/// Of frames that were measured (error_record.h) and still are what they were then. kInput: nothing
/// is promised, or no frame was measured.
Result<RaisePlan> plan_raises(const Campaign& campaign, const PreparedCampaign& prepared);

/// Changes what these frames are rendered with, and their ids, in one transaction: they are to be
/// rendered again. The job store remembers each raise. To be called before `prepared` is shared.
Status raise_frames(Campaign& campaign, PreparedCampaign& prepared, const RaisePlan& plan);

/// Frames that were ever raised.
Result<std::set<std::int64_t>> raised_frames(const Campaign& campaign);

}  // namespace seedframe
