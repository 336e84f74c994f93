// The options that submit and resume share, and what a run needs of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "image/color_management.h"

namespace CLI {
class App;
}

namespace seedframe {

struct RunArguments {
  std::string blender = "blender";
  int workers = 0;  ///< 0: chosen from the size of a frame and the cores
  int threads = 0;
  int max_attempts = 3;
  int max_crashes = 3;
  double frame_timeout_s = 600.0;
  double heartbeat_timeout_s = 120.0;
  int frames_per_worker = 2000;
  double worker_memory_gb = 0.0;  ///< 0: chosen
  bool sandbox = false;
  bool no_cache = false;
  double pause_limit_s = 600.0;
  bool no_space_check = false;
  bool quiet = false;
};

void add_run_options(CLI::App& verb, RunArguments& arguments);

/// Everything but the campaign that a run needs, found and checked before anything is written.
struct RunSetup {
  RunOptions options;
  std::optional<ColorManagement> color;  ///< none: labels by geometry, and Blender is not needed
};
Result<RunSetup> set_up_run(const RunArguments& arguments, const CampaignConfig& config,
                            std::int64_t frames);

/// "2 × Blender 3.4.1, threads each: 1", or "2 frames at once, threads each: 1, without Blender".
std::string describe(const RunSetup& setup);

}  // namespace seedframe
