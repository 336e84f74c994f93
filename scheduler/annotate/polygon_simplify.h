// Polygons with fewer vertices, nearly as exact.
#pragma once

#include <vector>

#include "annotate/mask.h"
#include "annotate/polygon.h"

namespace seedframe {

inline constexpr double kLeastSimplifiedIou = 0.99;

/// part_polygons on pixel edges, by the middles of the pixel edges, without those that are within a
/// tolerance of a straight line between their neighbours (Douglas & Peucker 1973). The tolerance is
/// halved from 4 px until what pycocotools makes of the polygons has the least IoU; where half a
/// pixel does not, or saves nothing, they stay exact. Coordinates are multiples of half a pixel.
std::vector<Polygon> simplified_polygons(const Mask& mask);

}  // namespace seedframe
