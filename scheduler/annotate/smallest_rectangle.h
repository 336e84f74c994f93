// The rectangle of least area around a mask, at any angle.
#pragma once

#include <array>

#include "annotate/mask.h"

namespace seedframe {

struct OrientedBox {
  /// x, y in pixels, (0, 0) the corner of the image; clockwise as seen in the image.
  std::array<std::array<double, 2>, 4> corners{};
  bool smallest = true;  ///< false: there is a smaller one that reaches beyond the image
};

/// Around the squares of the mask's pixels, among the rectangles whose corners all lie in the
/// image; the upright box is always one of them. One side of the smallest rectangle of all lies on
/// an edge of the convex hull (Freeman & Shapira 1975; the hull is CGAL's).
OrientedBox smallest_rectangle(const Mask& mask);

}  // namespace seedframe
