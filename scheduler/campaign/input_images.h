// The image files that a campaign may use, looked at before anything is rendered.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "campaign/campaign.h"
#include "scene/prepared_campaign.h"

namespace seedframe {

/// Decodes every image file that a frame can draw (scene/offered_images.h) as its use asks for
/// (assets/image_check.h), but for those whose content is known to be good in `cache`, a folder
/// that may be missing or empty. The kInput error names each that is not, and where the config
/// names it.
Status check_input_images(const PreparedCampaign& prepared, const std::filesystem::path& cache);

/// The same, if any input has changed since the campaign was submitted or renewed.
Status check_changed_images(const Campaign& campaign, const PreparedCampaign& prepared,
                            const std::filesystem::path& cache);

}  // namespace seedframe
