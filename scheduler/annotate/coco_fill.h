// Which pixels COCO's API gives to a polygon (pycocotools, rleFrPoly): not quite those whose
// centres are inside.
#pragma once

#include <cstdint>
#include <vector>

#include "annotate/mask.h"
#include "annotate/polygon.h"

namespace seedframe {

/// Intersection over union of what pycocotools makes of the polygons and the mask; 0 when a vertex
/// is outside the mask's box.
double coco_polygon_iou(const std::vector<Polygon>& polygons, const Mask& mask);

}  // namespace seedframe
