// A campaign as the data of a page: docs/report.md has every key.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "scene/prepared_campaign.h"

namespace seedframe {

struct PageWish {
  int threads = 1;
  std::int64_t most_frames = 100'000;  ///< of a larger campaign so many are shown, evenly spread
};

/// Called for one part of the frames after the other: thumbnails, masks, attempts and hashes, which
/// a page needs only for those that it shows.
using PartSink = std::function<Status(int part, const Json& content)>;

/// `prepared`: the campaign's config, or null where it cannot be read; `why_not` then says why, and
/// draws and constraints are left out. Frames that are damaged are told, never an error. The same
/// campaign gives the same data, whatever the threads.
Result<Json> campaign_page(const Campaign& campaign, const PreparedCampaign* prepared,
                           const std::string& why_not, const PageWish& wish, const PartSink& sink);

}  // namespace seedframe
