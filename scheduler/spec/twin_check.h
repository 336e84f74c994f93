// How a rendered frame is compared with its twin, and what one comparison found.
#pragma once

#include <cstdint>

namespace seedframe {

struct TwinTolerance {
  double inside_share = 1e-4;  ///< of all pixels, edges apart
  /// Of an instance's outline, and 8 pixels are always allowed: an instance that is a fraction of a
  /// pixel out of place differs in no other way.
  double outline_share = 0.1;
};

struct TwinCheck {
  bool wanted = true;  ///< false: rendered frames are not compared
  TwinTolerance tolerance;
};

/// A pixel that differs is an edge pixel if each image has the other's id within one pixel of it:
/// an outline that was rounded the other way. All others that differ are inside.
struct TwinTally {
  std::int64_t pixels = 0;  ///< compared; 0: no comparison was made
  std::int64_t inside_px = 0;
  std::int64_t edge_px = 0;

  bool operator==(const TwinTally&) const = default;
};

}  // namespace seedframe
