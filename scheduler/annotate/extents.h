// Area and tight box of every id in an instance-id image, measured in one pass.
#pragma once

#include <cstdint>
#include <vector>

#include "annotate/labels.h"
#include "image/image.h"

namespace seedframe {

struct InstanceExtent {
  int id = 0;
  std::int64_t area_px = 0;
  PixelRect box;
  int first_row = 0;     ///< of the first pixel in reading order
  int first_column = 0;  ///< of the same pixel
};

/// One entry for every id above 0 that the image holds, in the order of their first pixels.
std::vector<InstanceExtent> measure_extents(const Image<std::uint16_t>& instance_ids);

}  // namespace seedframe
