// Which pixels COCO's API gives to a polygon (pycocotools, rleFrPoly): not quite those whose
// centres are inside.
#pragma once

#include <cstdint>
#include <vector>

#include "annotate/labels.h"
#include "annotate/polygon.h"

namespace seedframe {

/// The pixels of `box` that any of the polygons covers, 0 or 1, row by row. No vertex may be
/// outside the box.
std::vector<std::uint8_t> coco_fill(const std::vector<Polygon>& polygons, const PixelRect& box);

}  // namespace seedframe
