#include "image/pixel_hash.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/sha256.h"

namespace seedframe {
namespace {

Image<float> two_pixels(float first, float second) {
  Image<float> image(2, 1);
  image.values = {first, second};
  return image;
}

TEST(PixelHash, IsTheHashOfTheHeaderAndTheBytesInFileOrder) {
  Image<std::uint16_t> ids(2, 1);
  ids.values = {1, 0x0203};
  const std::string hashed("seedframe-pixels-1\n2 1 uint16 X\n\x01\x00\x03\x02", 36);
  EXPECT_EQ(pixel_hash(ids, "X"), sha256_hex(hashed));
}

TEST(PixelHash, LiteralValuesNeverChange) {
  Image<std::uint8_t> rgb(1, 2, 3);
  rgb.values = {0, 127, 255, 1, 2, 3};
  EXPECT_EQ(pixel_hash(rgb, "R,G,B"),
            "7f6e5ebefdcda585c6db1a03c0c6ece31c4f162c340e2a5d955b61f40eff4bf0");
  Image<std::uint16_t> ids(2, 1);
  ids.values = {1, 0x0203};
  EXPECT_EQ(pixel_hash(ids, "X"),
            "e9d0393b1e9aed14d32ca9917238f7a765353cfcc558e2703aaf074bd43487be");
  EXPECT_EQ(pixel_hash(two_pixels(0.5F, -2.0F), "float", "Z"),
            "a9848eb645e4cb33c7ff94cefcef167ff1758bb1414d0229bd6bbd9fd6982f53");
  EXPECT_EQ(pixel_hash(two_pixels(0.5F, -2.0F), "half", "Z"),
            "01c204647a2026bd2fac17d7891d488b9b0941850bf8b40c15de0082d7b8e7f2");
}

TEST(PixelHash, DependsOnShapeTypeAndChannelNames) {
  Image<float> wide(2, 1), tall(1, 2), two_channels(1, 1, 2);
  EXPECT_NE(pixel_hash(wide, "float", "Z"), pixel_hash(tall, "float", "Z"));
  EXPECT_NE(pixel_hash(wide, "float", "Z"), pixel_hash(two_channels, "float", "Z"));
  EXPECT_NE(pixel_hash(wide, "float", "Z"), pixel_hash(wide, "half", "Z"));
  EXPECT_NE(pixel_hash(wide, "float", "Z"), pixel_hash(wide, "float", "X"));
}

TEST(PixelHash, EveryNaNIsOneNaN) {
  const float quiet = std::numeric_limits<float>::quiet_NaN();
  const float negative = std::copysign(quiet, -1.0F);
  const float payload = std::nanf("42");
  const std::string hash = pixel_hash(two_pixels(quiet, 1.0F), "float", "Z");
  EXPECT_EQ(pixel_hash(two_pixels(negative, 1.0F), "float", "Z"), hash);
  EXPECT_EQ(pixel_hash(two_pixels(payload, 1.0F), "float", "Z"), hash);
}

TEST(PixelHash, MinusZeroIsNotZero) {
  EXPECT_NE(pixel_hash(two_pixels(-0.0F, 1.0F), "float", "Z"),
            pixel_hash(two_pixels(0.0F, 1.0F), "float", "Z"));
}

TEST(PixelHash, AnEmptyImageHasOne) {
  EXPECT_EQ(pixel_hash(Image<float>(0, 0), "float", "Z"),
            sha256_hex("seedframe-pixels-1\n0 0 float Z\n"));
}

}  // namespace
}  // namespace seedframe
