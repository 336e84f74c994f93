// Frames that are nearly the same: a detector learns nothing from the second.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "page/frame_table.h"
#include "page/thumbnail.h"

namespace seedframe {

struct DuplicateRules {
  double box_share = 0.01;  ///< of the image's width: that much each side of a box may differ
  double least_box_px = 1;  ///< but at least by this
  double code_values = 3;   ///< root mean square difference of the pictures' signatures
};

/// Places in the table, rising, of frames each of which is near another one of the group: they show
/// the same numbers of each class, every box in nearly the same place, and (where there are
/// pictures) nearly the same colours. Frames that show nothing labelled are compared by their
/// pictures only, and not at all where there are none. Groups by their first frame.
std::vector<std::vector<std::size_t>> near_duplicates(
    const FrameTable& table, const std::vector<std::optional<PictureSignature>>& signatures,
    int image_width, const DuplicateRules& rules = {});

}  // namespace seedframe
