// The run that a campaign's config asks for.
#pragma once

#include <memory>

#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/provenance.h"
#include "image/color_management.h"

namespace seedframe {

/// `color` is null when labels come from geometry, without Blender. All but the options must
/// outlive the run.
std::unique_ptr<CampaignRun> make_run(Campaign& campaign, PreparedCampaign& prepared,
                                      const ColorManagement* color, Provenance& provenance,
                                      const RunOptions& options, RunObserver& observer);

}  // namespace seedframe
