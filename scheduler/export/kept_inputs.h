// What exports need to know of a campaign beside its frames: kept in its folder, so that a campaign
// can be moved to where its config and its assets are not (docs/formats/campaign.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "assets/offered_asset.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "frames/campaign_files.h"
#include "scene/prepared_campaign.h"

namespace seedframe {

struct KeptInputs {
  std::string name;
  std::uint64_t seed = 0;
  std::vector<std::string> categories;
  std::vector<OfferedAsset> assets;  ///< by name
  bool has_images = true;            ///< false: labels only, nothing was rendered
  bool has_depth = false;
  ImageFormat image_format = ImageFormat::kPng;
};

Result<KeptInputs> inputs_of(const PreparedCampaign& prepared);

/// Writes them into the campaign's folder, with copies of the assets; what is there already, stays.
Status keep_inputs(const CampaignFiles& files, const KeptInputs& inputs);

/// Nothing where none were kept. Files that are not as they were written are an error (kCorrupt).
Result<std::optional<KeptInputs>> read_kept_inputs(const CampaignFiles& files);

/// Those; or of a campaign that was made before any were kept, from its config (prepare_again).
Result<KeptInputs> inputs_of(const Campaign& campaign, const std::filesystem::path& home,
                             const std::vector<std::string>& allowed);

}  // namespace seedframe
