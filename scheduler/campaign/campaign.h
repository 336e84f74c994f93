// A campaign on disk: its folder, its store, and the config it was made from.
#pragma once

#include <filesystem>
#include <vector>

#include "base/campaign_files.h"
#include "base/error.h"
#include "base/manifest.h"
#include "campaign/campaign_lock.h"
#include "campaign/prepared_campaign.h"
#include "render/frame_job.h"
#include "store/job_store.h"

namespace seedframe {

struct Campaign {
  CampaignFiles files;
  JobStore store;
};

/// Makes the folder, campaign.yaml and the store with every frame pending. The folder must not
/// exist, or be empty (kInput). Every frame is expanded on its way into the store, so memory does
/// not grow with their number; a folder that was made here goes again when something fails.
Result<Campaign> create_campaign(const std::filesystem::path& folder, PreparedCampaign& prepared);

/// Opens what create_campaign made. Not a campaign, or damaged: an error that says so.
Result<Campaign> open_campaign(const std::filesystem::path& folder);

/// The source that the campaign was made from: its own campaign.yaml, and from the store the
/// overrides and the folder at which relative paths start.
Result<CampaignSource> source_of(const Campaign& campaign, const std::filesystem::path& home);

struct Reconciliation {
  std::vector<PendingFrame> to_render;  ///< in order
  std::int64_t already_done = 0;
  std::int64_t adopted = 0;          ///< complete on disk though the store did not know
  std::vector<std::string> invalid;  ///< why frames that were done must be rendered again
};

/// Makes store and disk agree, as a scheduler does when it starts: what is done and verified stays,
/// what lies complete in its final folder is taken over, all else is to be rendered; scratch
/// folders are removed.
Result<Reconciliation> reconcile(Campaign& campaign, VerifyDepth depth);

}  // namespace seedframe
