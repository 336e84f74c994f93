// A contact sheet of frames of a campaign, whatever has become of each of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "export/dataset.h"
#include "picture/contact_sheet.h"
#include "picture/layers.h"
#include "picture/stored_frame.h"

namespace seedframe {

struct SheetWish {
  std::vector<std::int64_t> frames;
  /// A tile of each frame for each of them: below each other; of a single frame, side by side.
  std::vector<LayerSet> tiles;
  int columns = 0;     ///< 0: as it looks well
  int tile_width = 0;  ///< pixels, at most; 0: 320, and 640 for a single frame
  bool plain = false;  ///< tiles alone: no title, captions or legend
};

struct CampaignSheet {
  ContactSheet sheet;
  /// About frames that could not be shown, a line each: "frame 7 failed: …".
  std::vector<std::string> complaints;
  bool any_corrupt = false;  ///< of these: files that are not as they were written
};

/// Frames to look at when nobody says which: at most `most` of those that are done or came to
/// nothing, spread over the campaign. Empty: none was begun yet.
Result<std::vector<std::int64_t>> frames_worth_showing(const Campaign& campaign, std::int64_t most);

/// What is shown of frames when nobody says what: by whether there are images, and how many frames.
std::vector<LayerSet> usual_tiles(const Dataset& dataset, std::size_t frames);

/// A frame that failed, is damaged or is not there yet is a tile that says so. kInput error: a
/// frame that the campaign does not have.
Result<CampaignSheet> make_sheet(const Campaign& campaign, const Dataset& dataset,
                                 const SheetWish& wish, const FrameExpansion& expand);

}  // namespace seedframe
