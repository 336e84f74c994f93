// The boundary of a mask as closed walks over pixel edges.
//
// Connectivity: the mask is 8-connected and the background 4-connected. Two mask pixels that touch
// at a corner are one part; two background pixels that touch at a corner are not one hole.
#pragma once

#include <cstddef>
#include <vector>

#include "annotate/mask.h"

namespace seedframe {

/// In the order in which a walk with the mask on its right turns right: east along a top side,
/// south along a right side, west along a bottom side, north along a left side.
enum class Side { kTop, kRight, kBottom, kLeft };

/// A side of a mask pixel that has background or the outside of the image beyond it.
struct Crack {
  int row = 0;
  int column = 0;
  Side side = Side::kTop;
};

/// Cracks [first, first + count) of Boundary::cracks, in the order of the walk.
struct CrackRing {
  std::size_t first = 0;
  std::size_t count = 0;
  bool hole = false;
};

/// Every crack of the mask belongs to exactly one ring. With rows downwards, outer rings run
/// clockwise and holes counterclockwise. Rings are ordered by their first top side in reading
/// order.
struct Boundary {
  std::vector<Crack> cracks;
  std::vector<CrackRing> rings;
  std::vector<std::size_t> ring_of_crack;

  /// Index of the top side of a pixel, which must be a crack.
  std::size_t top_crack(int row, int column) const;

  PixelRect box;
  std::vector<std::ptrdiff_t> top_cracks;  ///< for each pixel of the box; -1: no crack
};

Boundary trace_boundary(const Mask& mask);

}  // namespace seedframe
