// The run that a campaign's config asks for.
#pragma once

#include <memory>

#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/provenance.h"
#include "campaign/run_options.h"

namespace seedframe {

/// All but the setup must outlive the run.
std::unique_ptr<CampaignRun> make_run(Campaign& campaign, const PreparedCampaign& prepared,
                                      Provenance& provenance, const RunSetup& setup,
                                      RunObserver& observer);

}  // namespace seedframe
