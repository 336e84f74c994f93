// A mask as polygons that decode to exactly the same mask.
//
// The rings run on pixel edges (boundary.h). Annotation formats know no holes, so a hole is joined
// to the ring above it by a keyhole: a bridge of no width, walked there and back, over mask pixels
// only. A decoder that counts crossings meets the bridge twice and is not changed by it.
#pragma once

#include <cstdint>
#include <vector>

#include "annotate/mask.h"

namespace seedframe {

inline constexpr std::int32_t kVerticesPerPixel = 100;

/// In hundredths of a pixel: x to the right, y down, (0, 0) the top left corner of the image.
struct Vertex {
  std::int32_t x = 0;
  std::int32_t y = 0;
  bool operator==(const Vertex&) const = default;
};

/// Closed: the last vertex is joined to the first, and not repeated.
using Polygon = std::vector<Vertex>;

/// Where a corner of a mask pixel is placed, in hundredths of a pixel from the pixel's left or
/// upper edge: `low` for its left and upper corners, `high` for its right and lower corners.
struct VertexPlacement {
  std::int32_t low = 0;
  std::int32_t high = kVerticesPerPixel;
};

/// On the pixel edges: exact where polygons are rasterised with sub-pixel crossings (COCO).
inline constexpr VertexPlacement kOnPixelEdges{0, kVerticesPerPixel};
/// 0.02 px inside the mask: every vertex truncates to the pixel that it belongs to (ultralytics).
inline constexpr VertexPlacement kInsidePixelEdges{2, kVerticesPerPixel - 2};
/// Truncates and rounds to the pixel that it belongs to, for loaders that round; right and lower
/// edges stand 0.52 px inside the mask. Points between vertices do not where corners touch.
inline constexpr VertexPlacement kNearestToPixels{2, 48};

/// Outer rings run clockwise as seen in the image (y down), holes counterclockwise.
struct BoundaryRing {
  bool hole = false;
  Polygon polygon;
};

/// Every ring of the mask on its own, ordered by their first top side in reading order.
std::vector<BoundaryRing> boundary_rings(const Mask& mask);

/// One polygon for each 8-connected part of the mask, its holes joined by keyholes. The union of
/// the polygons is the mask. Ordered by the first pixel of the part in reading order.
std::vector<Polygon> part_polygons(const Mask& mask, const VertexPlacement& placement);

struct WholePolygon {
  Polygon polygon;               ///< empty for an empty mask
  std::int64_t left_out_px = 0;  ///< of the parts that are not in it
};

/// One polygon for the whole mask: parts are joined by bridges of no width too, the shortest there
/// are, along a diagonal and then a row or a column. Those cross background, and a decoder that
/// also fills the polygon's outline paints the pixels under them; nothing else can be said in one
/// polygon. A part with fewer pixels than its bridge would paint is left out, unless the mask's box
/// would be another without it.
WholePolygon whole_polygon(const Mask& mask, const VertexPlacement& placement);

}  // namespace seedframe
