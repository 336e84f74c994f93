// What each frame is rendered with, where a config says how wrong frames may be.
#pragma once

#include "base/error.h"
#include "campaign/run_options.h"
#include "scene/prepared_campaign.h"

namespace seedframe {

/// Calibrates (quality/calibration.h), tells a terminal of it, and sets the expander's choices.
Status choose_settings(PreparedCampaign& prepared, const RunSetup& setup);

}  // namespace seedframe
