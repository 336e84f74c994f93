// The run that submit and resume both start, told to a terminal.
#pragma once

#include <vector>

#include "campaign/campaign.h"
#include "campaign/run_options.h"

namespace seedframe {

/// Runs the frames (campaign/campaign_runner.h) with a progress bar, Ctrl-C draining, and prints
/// how it ended and what to do next. Returns the exit code.
int run_campaign(Campaign& campaign, const PreparedCampaign& prepared, const UsedFiles& used,
                 RunSetup& setup, std::vector<PendingFrame> frames);

}  // namespace seedframe
