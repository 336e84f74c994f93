// A campaign as the exporters see it.
#pragma once

#include <cstdint>

#include "base/error.h"
#include "campaign/campaign.h"
#include "export/dataset.h"
#include "export/kept_inputs.h"

namespace seedframe {

struct CampaignDataset {
  Dataset dataset;
  std::int64_t missing = 0;  ///< frames that are not done
};

/// Looks at the store only. Frames that are not done are left out. The campaign must outlive it.
Result<CampaignDataset> campaign_dataset(const Campaign& campaign, KeptInputs inputs);

}  // namespace seedframe
