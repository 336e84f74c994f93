// Which pixels a polygon covers: those whose centres are inside it, by the even-odd rule.
#pragma once

#include <cstdint>
#include <vector>

#include "annotate/labels.h"
#include "annotate/mask.h"
#include "annotate/polygon.h"

namespace seedframe {

/// The pixels of `box` that any of the polygons covers, 0 or 1, row by row.
std::vector<std::uint8_t> fill_polygons(const std::vector<Polygon>& polygons, const PixelRect& box);

enum class FillRule {
  kCentres,  ///< fill_polygons
  kCoco,     ///< coco_fill
};

/// Intersection over union of the polygons' pixels and the mask; 0 when a vertex is outside the
/// mask's box.
double polygon_iou(const std::vector<Polygon>& polygons, const Mask& mask, FillRule rule);

}  // namespace seedframe
