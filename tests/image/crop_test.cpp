#include "image/crop.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(Crop, TakesARectangle) {
  Image<std::uint8_t> image(4, 3, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<std::uint8_t>(i);
  }
  const auto out = cropped(image, 1, 1, 2, 2);
  EXPECT_EQ(out.values,
            (std::vector<std::uint8_t>{15, 16, 17, 18, 19, 20, 27, 28, 29, 30, 31, 32}));
}

}  // namespace
}  // namespace seedframe
