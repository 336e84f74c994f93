// From a config to what holds for all of its frames.
#pragma once

#include "config/campaign_config.h"
#include "spec/campaign_settings.h"

namespace seedframe {

CampaignSettings settings_of(const CampaignConfig& config);

}  // namespace seedframe
