#include "picture/pixel_scaling.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/fixtures/image_bytes.h"

namespace seedframe {
namespace {

Image<std::uint8_t> grey_row(const std::vector<int>& values) {
  Image<std::uint8_t> image(static_cast<int>(values.size()), 1, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<std::uint8_t>(values[i / 3]);
  }
  return image;
}

TEST(Shrunk, IsTheMeanOfTheLight) {
  EXPECT_EQ(shrunk(grey_row({0, 255}), 1, 1).at(0, 0), 188) << "half the light, not half the code";
}

TEST(Shrunk, WeighsPixelsByTheirCoveredPart) {
  // Of three pixels two: each covers one and a half.
  const Image<std::uint8_t> two = shrunk(grey_row({255, 0, 0}), 2, 1);
  EXPECT_EQ(two.at(0, 0), 213) << "two thirds of the light";
  EXPECT_EQ(two.at(0, 1), 0);
}

TEST(Shrunk, KeepsWhatIsAllTheSame) {
  for (int code = 0; code < 256; ++code) {
    Image<std::uint8_t> flat(13, 7, 3);
    std::fill(flat.values.begin(), flat.values.end(), static_cast<std::uint8_t>(code));
    const Image<std::uint8_t> small = shrunk(flat, 5, 3);
    EXPECT_EQ(std::count(small.values.begin(), small.values.end(), code), 5 * 3 * 3) << code;
  }
}

TEST(Shrunk, ToItsOwnSizeIsTheImage) {
  const Image<std::uint8_t> image = colorful_image(9, 5);
  EXPECT_EQ(shrunk(image, 9, 5).values, image.values);
}

TEST(Enlarged, MakesSquaresOfPixels) {
  const Image<std::uint8_t> image = colorful_image(3, 2);
  const Image<std::uint8_t> large = enlarged(image, 4);
  ASSERT_EQ(large.width, 12);
  ASSERT_EQ(large.height, 8);
  for (int row = 0; row < large.height; ++row) {
    for (int column = 0; column < large.width; ++column) {
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_EQ(large.at(row, column, channel), image.at(row / 4, column / 4, channel));
      }
    }
  }
  EXPECT_EQ(enlarged(image, 1).values, image.values);
}

}  // namespace
}  // namespace seedframe
