// How far a frame is from what it should be.
#pragma once

#include <cstdint>

#include "image/difference.h"

namespace seedframe {

/// Worse ones later.
enum class Grade {
  kIdentical,
  kRounding,         ///< labels identical, colours within some units in the last place
  kTolerance,        ///< labels identical, colours within the tolerance
  kLabels,           ///< labels differ
  kNotReproducible,  ///< colours beyond the tolerance, or no picture at all
};
const char* to_string(Grade grade);

/// What colours may differ by. Scene-linear values; all bounds must hold.
struct Tolerance {
  std::int64_t ulp = 4;   ///< units in the last place of a half float that count as rounding
  double max = 0.05;      ///< of any value
  double rms = 0.005;     ///< over all values
  double psnr_db = 40.0;  ///< at least; of a range of 1
  double pixels = 1.0;    ///< share of pixels that may differ at all
};

/// Of colours whose labels are identical.
Grade grade_of_colors(const ImageDifference& difference, const Tolerance& tolerance);

}  // namespace seedframe
