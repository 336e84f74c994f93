// Our differences beside those of OpenImageIO. The program has its own because it also counts
// pixels and steps, lets NaN equal NaN, and reads nothing but what it has in memory.

#include "image/difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

OIIO::ImageBuf buffer_of(Image<float>& image) {
  return OIIO::ImageBuf(OIIO::ImageSpec(image.width, image.height, image.channels, OIIO::TypeFloat),
                        image.values.data());
}

TEST(DifferenceAndOpenImageIO, GiveTheSameFigures) {
  constexpr float kAny = std::numeric_limits<float>::max();  // no difference is a failure
  std::mt19937 random(7);
  for (const int channels : {1, 2, 3, 4, 7}) {
    for (const float step : {1e-6f, 0.01f, 300.0f}) {
      Image<float> a(31, 17, channels);
      for (float& value : a.values) value = static_cast<float>(random() % 1000) / 500.0f;
      Image<float> b = a;
      for (std::size_t i = 0; i < a.values.size(); ++i) {
        if (i % 3 != 0) b.values[i] += static_cast<float>(random() % 7) * step;
      }
      const auto theirs = OIIO::ImageBufAlgo::compare(buffer_of(a), buffer_of(b), kAny, kAny);
      ASSERT_FALSE(theirs.error);
      const ImageDifference ours = difference_of(a, b, StoredAs::kFloat);
      ASSERT_GT(ours.rms, 0.0);
      EXPECT_NEAR(ours.max, theirs.maxerror, 1e-6 * ours.max);
      EXPECT_NEAR(ours.rms, theirs.rms_error, 1e-8 * ours.rms);  // theirs are of floats
      const double peak = *std::max_element(b.values.begin(), b.values.end());
      EXPECT_NEAR(ours.psnr_db(peak), 20.0 * std::log10(peak / theirs.rms_error), 1e-6);
    }
  }
}

}  // namespace
}  // namespace seedframe
