// What is promised of a campaign's errors, and what is known of whether it is kept.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "quality/promise.h"

namespace seedframe {

/// From frames that were measured (quality/error_record.h) and still are what they were then. A
/// frame that was raised since (quality/raise.h) says nothing about those that nobody measured: as
/// it was chosen, it was beyond the bound, and so it counts for them.
struct PromiseStatus {
  ErrorPromise promise;
  int checked = 0;            ///< frames: measured as they are now, or raised
  int reference_samples = 0;  ///< the least of theirs
  EstimatedShare as_chosen;   ///< of them within the bound, as they were chosen
  /// Of all frames: those measured as they are now, the others as those were when they were chosen.
  double share_now = 0.0;
  bool is_kept = false;  ///< share_now is the promised one or more
  std::vector<FrameError> beyond;
  std::vector<std::int64_t> raised;             ///< of the checked frames
  std::vector<std::int64_t> raised_unmeasured;  ///< of these, those not measured since
};

/// Nothing: the campaign promises nothing, or was made before promises were kept in its store.
Result<std::optional<PromiseStatus>> read_promise_status(const Campaign& campaign);

Json to_json(const PromiseStatus& status);

/// For people, a line for each thing that is to be said, with the commands for `folder` that follow
/// from it.
std::vector<std::string> lines_of(const PromiseStatus& status, const std::string& folder);

}  // namespace seedframe
