// Two campaigns, by their trees of hashes first, then the frames that differ.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "audit/frame_difference.h"
#include "campaign/campaign.h"

namespace seedframe {

struct ComparedFrame {
  enum class Kind {
    kOnlyInFirst,  ///< the other has no such frame, or it is not done
    kOnlyInSecond,
    kOtherSpec,    ///< something else was asked for
    kOtherPixels,  ///< the same was asked for
  };
  std::int64_t frame = 0;
  Kind kind = Kind::kOtherPixels;
  std::vector<std::string> spec;              ///< what was asked for otherwise
  std::optional<FrameDifference> difference;  ///< of frames that were looked at
  std::string provenance;                     ///< what else the second was made with; may be empty
};
const char* to_string(ComparedFrame::Kind kind);

struct CampaignComparison {
  std::string first_hash, second_hash;  ///< of the datasets; empty when incomplete
  std::int64_t identical = 0;           ///< frames that are done in both, and the same
  std::vector<ComparedFrame> frames;    ///< all others, in order
  Grade grade = Grade::kIdentical;      ///< the worst of those that were looked at

  std::int64_t count(ComparedFrame::Kind kind) const;
};

/// Reads the pixels of the first `most_frames` that differ. `heat_maps`, if not empty, is a folder
/// for a picture of each of these: <index>.png.
Result<CampaignComparison> compare_campaigns(const Campaign& first, const Campaign& second,
                                             const Tolerance& tolerance, std::int64_t most_frames,
                                             const std::filesystem::path& heat_maps);

Json to_json(const CampaignComparison& comparison);

}  // namespace seedframe
