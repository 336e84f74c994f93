// What a campaign will cost, told by a few of its frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/run_options.h"
#include "scene/prepared_campaign.h"
#include "store/job_store.h"

namespace seedframe {

struct Forecast {
  std::int64_t frames = 0;  ///< that it is told of
  int pilots = 0;           ///< that were made for it
  double wall_s = 0.0;      ///< from the command to its end
  double frame_s = 0.0;     ///< of one worker for a frame, mean of the pilots
  double spread = 0.0;      ///< standard error of that mean, as a share of it
  std::uint64_t bytes = 0;  ///< on the disk
};

/// All but the bytes, of `frames` frames by so many workers. `pilots` are attempts in the order in
/// which they began, at least one, and `begin` (Unix time, seconds) is when the run was started: a
/// worker's first frame reads meshes and images, so it counts as start-up where there are others.
Forecast told_by(const std::vector<AttemptRow>& pilots, double begin, int workers,
                 std::int64_t frames);

/// Told by the newest frames of a campaign, if some of them were made by workers with as many
/// pixels and samples as `settings` have; nothing otherwise. `pilots` are those frames; the start
/// of workers is left out.
Result<std::optional<Forecast>> told_by(const Campaign& campaign, const CampaignSettings& settings,
                                        int workers, std::int64_t frames);

/// Makes `pilots` frames, spread over the first `frames` of the campaign, as a run would make them:
/// in `folder`, which becomes new and is not cleared away. Nothing comes from the cache or goes
/// there. A kRender error if any of them fails.
Result<Forecast> forecast(const PreparedCampaign& prepared, RunSetup setup, std::int64_t frames,
                          int pilots, const std::filesystem::path& folder, RunObserver& observer);

}  // namespace seedframe
