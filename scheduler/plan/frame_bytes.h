// How much room a frame takes on the disk.
#pragma once

#include <cstdint>

#include "spec/campaign_settings.h"

namespace seedframe {

/// Bytes that a frame of this campaign typically takes. Measured on configs/parts.yaml (320 x 240
/// with depth and normals at 32 samples: 2.78 MB; this says 2.81), so of other scenes half or twice
/// as many are possible.
std::uint64_t typical_frame_bytes(const CampaignSettings& settings);

}  // namespace seedframe
