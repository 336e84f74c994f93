// What is known of how a campaign's frames were made, as JSON for a page (docs/report.md). Nothing
// here is needed to show frames: what cannot be read is told, and left out.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "campaign/campaign.h"
#include "page/health.h"
#include "page/told_text.h"
#include "report/campaign_status.h"

namespace seedframe {

/// Frames that failed or are quarantined, with their last words and what was refused of them;
/// `count` tells how many there are where these are only the first.
Result<Json> failures_json(const Campaign& campaign, const ToldText& told);

/// Of the last audit that is in the campaign's folder, with pictures of what differs; null: there
/// is none.
Json audit_json(const CampaignFiles& files, const ToldText& told);

/// What is promised of errors, and each error that was measured of a frame as it is now; null:
/// nothing is, and none was.
Result<Json> errors_json(const Campaign& campaign, const std::optional<PromiseStatus>& promise);

/// The exports in the campaign's folder, and which scenes are in which of their parts.
struct ExportsFound {
  Json json = Json::array();
  std::vector<SplitScenes> splits;
};
ExportsFound exports_found(const Campaign& campaign, const ToldText& told);

}  // namespace seedframe
