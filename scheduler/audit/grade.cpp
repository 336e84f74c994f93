#include "audit/grade.h"

#include <array>

namespace seedframe {

const char* to_string(Grade grade) {
  constexpr std::array<const char*, 5> kNames = {"identical", "rounding", "tolerance", "labels",
                                                 "not reproducible"};
  return kNames[static_cast<std::size_t>(grade)];
}

Grade grade_of_colors(const ImageDifference& difference, const Tolerance& tolerance) {
  if (difference.differing == 0) return Grade::kIdentical;
  if (difference.max_ulp <= tolerance.ulp) return Grade::kRounding;
  const bool within = difference.max <= tolerance.max && difference.rms <= tolerance.rms &&
                      difference.psnr_db(1.0) >= tolerance.psnr_db &&
                      difference.differing_share() <= tolerance.pixels;
  return within ? Grade::kTolerance : Grade::kNotReproducible;
}

}  // namespace seedframe
