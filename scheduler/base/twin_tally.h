// What one comparison of a rendered frame with its twin found.
#pragma once

#include <cstdint>

namespace seedframe {

/// A pixel that differs is an edge pixel if each image has the other's id within one pixel of it:
/// an outline that rounds another way. All others that differ are inside.
struct TwinTally {
  std::int64_t pixels = 0;  ///< compared; 0: no comparison was made
  std::int64_t inside_px = 0;
  std::int64_t edge_px = 0;

  bool operator==(const TwinTally&) const = default;
};

}  // namespace seedframe
