// How far a campaign is, as data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/clock.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "report/promise_status.h"
#include "slurm/cluster_state.h"

namespace seedframe {

/// A worker that is there, as its run has noted it.
struct WorkerStatus {
  WorkerRow row;
  std::string name;
  double frame_for_s = 0.0;  ///< that it has been at its frame
};

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
  std::vector<WorkerStatus> workers;        ///< while one is: those that render
  std::optional<double> left_s;             ///< while one is: what is left at the run's rate
  std::optional<ClusterState> cluster;      ///< of a run by Slurm that is not over
  std::vector<std::string> inputs_touched;  ///< files that are not as they were for its frames
};

/// `now`: Unix time, seconds.
Result<CampaignStatus> read_status(const Campaign& campaign, double now = unix_time());

Json to_json(const CampaignStatus& status);

/// What some attempts were made with and others were not, a line each: their pixels are not
/// comparable.
std::vector<std::string> mixed_provenances(const CampaignStatus& status);

}  // namespace seedframe
