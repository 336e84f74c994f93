// Which grade a difference of colours gets.

#include "audit/grade.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

ImageDifference differing_by(double max, double rms, std::int64_t ulp, std::int64_t pixels = 10) {
  ImageDifference difference;
  difference.pixels = 1000;
  difference.differing = pixels;
  difference.max = max;
  difference.rms = rms;
  difference.max_ulp = ulp;
  return difference;
}

TEST(Grade, RoundingIsAFewUnitsInTheLastPlaceHoweverMany) {
  EXPECT_EQ(grade_of_colors(differing_by(0, 0, 0, 0), {}), Grade::kIdentical);
  EXPECT_EQ(grade_of_colors(differing_by(8.0, 4.0, 4, 1000), {}), Grade::kRounding);
  EXPECT_EQ(grade_of_colors(differing_by(1e-3, 1e-5, 5), {}), Grade::kTolerance);
}

TEST(Grade, EveryBoundOfTheToleranceCounts) {
  const Tolerance tolerance = {.ulp = 0, .max = 0.1, .rms = 0.01, .psnr_db = 20.0, .pixels = 0.5};
  EXPECT_EQ(grade_of_colors(differing_by(0.1, 0.01, 9, 500), tolerance), Grade::kTolerance);
  EXPECT_EQ(grade_of_colors(differing_by(0.11, 0.01, 9), tolerance), Grade::kNotReproducible);
  EXPECT_EQ(grade_of_colors(differing_by(0.1, 0.011, 9), tolerance), Grade::kNotReproducible);
  EXPECT_EQ(grade_of_colors(differing_by(0.1, 0.01, 9, 501), tolerance), Grade::kNotReproducible);
  Tolerance quiet = tolerance;
  quiet.psnr_db = 41.0;  // a root mean square of 0.01 is 40 dB
  EXPECT_EQ(grade_of_colors(differing_by(0.1, 0.01, 9), quiet), Grade::kNotReproducible);
}

}  // namespace
}  // namespace seedframe
