// The run that submit and resume both start, from the first frame to its last word.
#pragma once

#include <vector>

#include "campaign/campaign.h"
#include "cli/run_options.h"

namespace seedframe {

/// Renders the frames with a progress bar, Ctrl-C draining, and prints how it ended and what to do
/// next. When the disk or another resource is exhausted it pauses, looks now and then whether it is
/// back, and goes on with what is missing. Returns the exit code. `campaign` is opened anew after a
/// pause. `used`: by the frames that were expanded before, for the provenance.
int run_campaign(Campaign& campaign, PreparedCampaign& prepared, const UsedFiles& used,
                 RunSetup& setup, std::vector<PendingFrame> frames);

}  // namespace seedframe
