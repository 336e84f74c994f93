// Whether provenance.json says what the campaign was made from.
#pragma once

#include <string>
#include <vector>

#include "assets/used_files.h"
#include "base/error.h"
#include "campaign/campaign.h"

namespace seedframe {

/// Complaints; none if all is as it should be. `used`: what the done frames are made of today.
/// Without `prepared` (something else is asked for than was, or nobody knows), only what attempts
/// were made with is compared, with the job store.
std::vector<std::string> wrong_provenance(const Campaign& campaign,
                                          const PreparedCampaign* prepared, const UsedFiles& used);

/// Whether all attempts were labelled by rays that have the last bits of ours.
Result<bool> traced_like_here(const JobStore& store);

}  // namespace seedframe
