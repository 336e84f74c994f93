// The options that submit and resume share, and the run that they both start.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign_run.h"

namespace CLI {
class App;
}

namespace seedframe {

struct RunArguments {
  std::string blender = "blender";
  int workers = 0;  ///< 0: chosen from the size of a frame and the cores
  int threads = 0;
  int max_attempts = 3;
  double frame_timeout_s = 600.0;
  bool quiet = false;
};

void add_run_options(CLI::App& verb, RunArguments& arguments);

/// Everything but the campaign that a run needs, found and checked before anything is written.
struct RunSetup {
  BlenderInfo blender;
  ColorManagement color;
  RunOptions options;
};
Result<RunSetup> set_up_run(const RunArguments& arguments, const CampaignConfig& config,
                            std::int64_t frames);

/// Renders the frames with a progress bar, Ctrl-C draining, and prints how it ended and what to do
/// next. Returns the exit code.
int run_campaign(Campaign& campaign, PreparedCampaign& prepared, const RunSetup& setup,
                 const std::vector<PendingFrame>& frames, const RunArguments& arguments);

}  // namespace seedframe
