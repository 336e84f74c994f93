#include "image/resize.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

Image<std::uint8_t> of_one_color(int width, int height, std::array<std::uint8_t, 3> color) {
  Image<std::uint8_t> image(width, height, 3);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      for (int c = 0; c < 3; ++c) image.at(row, column, c) = color[static_cast<std::size_t>(c)];
    }
  }
  return image;
}

TEST(Resize, OneColourStaysWhatItIs) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(7, 90), std::pair(300, 2)}) {
    const auto out = resized(of_one_color(width, height, {200, 3, 77}), 32, 32);
    EXPECT_EQ(out.values, of_one_color(32, 32, {200, 3, 77}).values) << width;
  }
}

TEST(Resize, TheSameSizeIsTheSameImage) {
  Image<std::uint8_t> image(5, 4, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<std::uint8_t>(37 * i);
  }
  EXPECT_EQ(resized(image, 5, 4).values, image.values);
}

// Half black and half white is 188 in sRGB; a mean of the stored numbers would be 128.
TEST(Resize, MixesLightAndNotItsCode) {
  Image<std::uint8_t> image(64, 64, 3);
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      for (int c = 0; c < 3; ++c) image.at(row, column, c) = (row + column) % 2 == 0 ? 255 : 0;
    }
  }
  const auto out = resized(image, 8, 8);
  EXPECT_NEAR(out.at(4, 4, 0), 188, 2);
}

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
