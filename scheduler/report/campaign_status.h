// How far a campaign is, as data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "report/promise_status.h"

namespace seedframe {

struct CampaignStatus {
  FrameCounts counts;
  std::optional<AttemptTimings> timings;  ///< means over the newest attempts
  std::vector<AttemptRow> failures;       ///< the newest first
  std::vector<FrameRow> quarantined;      ///< some of them
  TwinSummary twin;
  std::string dataset_hash;                 ///< empty until the campaign is complete
  std::vector<std::string> provenances;     ///< of attempts, as JSON
  std::optional<PromiseStatus> promise;     ///< of how wrong frames are
  bool running = false;                     ///< a scheduler is at work
  std::vector<std::string> inputs_touched;  ///< files that are not as they were for its frames
};

Result<CampaignStatus> read_status(const Campaign& campaign);

Json to_json(const CampaignStatus& status);

/// What some attempts were made with and others were not, a line each: their pixels are not
/// comparable.
std::vector<std::string> mixed_provenances(const CampaignStatus& status);

}  // namespace seedframe
