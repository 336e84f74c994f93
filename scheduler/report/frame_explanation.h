// Everything that is known about one frame of a campaign, as data.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "frames/manifest.h"

namespace seedframe {

struct FrameExplanation {
  FrameRow row;
  ExpandedFrame expanded;  ///< as it would be today, with its draws
  std::vector<AttemptRow> attempts;
  std::optional<Manifest> manifest;  ///< none: its folder holds no frame
};

/// A kInput error for a frame that the campaign does not have.
Result<FrameExplanation> explain_frame(const Campaign& campaign, const PreparedCampaign& prepared,
                                       std::int64_t frame);

/// Of an attempt; null if there is none.
Json provenance_of(const AttemptRow& attempt);

/// `render_again`: the command that renders it again.
Json to_json(const FrameExplanation& explanation, const std::string& render_again);

}  // namespace seedframe
