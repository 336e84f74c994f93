#include "image_files/image_writer.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "image_files/image_reader.h"

namespace seedframe {
namespace {

Image<std::uint8_t> gradient(int width, int height) {
  Image<std::uint8_t> image(width, height, 3);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      image.at(row, column, 0) = static_cast<std::uint8_t>(255 * column / width);
      image.at(row, column, 1) = static_cast<std::uint8_t>(255 * row / height);
      image.at(row, column, 2) = 40;
    }
  }
  return image;
}

const std::vector<ImageEncoding>& lossless_encodings() {
  static const std::vector<ImageEncoding> kEncodings = {
      {.kind = ImageKind::kPng, .png_level = 0},
      {.kind = ImageKind::kPng, .png_level = 9},
      {.kind = ImageKind::kTiff, .tiff = TiffCompression::kNone},
      {.kind = ImageKind::kTiff, .tiff = TiffCompression::kLzw},
      {.kind = ImageKind::kTiff, .tiff = TiffCompression::kZip}};
  return kEncodings;
}

TEST(ImageWriter, LosslessKindsGiveThePixelsBack) {
  const Image<std::uint8_t> image = gradient(97, 71);
  for (const ImageEncoding& encoding : lossless_encodings()) {
    const Result<std::string> bytes = encode_image(image, encoding);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto read = decode_image8(*bytes, encoding.kind, "it");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->width, 97);
    EXPECT_EQ(read->channels, 3);
    EXPECT_EQ(read->values, image.values) << name_of(encoding.kind);
  }
}

TEST(ImageWriter, JpegAndWebpAreCloserAndLargerWithMoreQuality) {
  const Image<std::uint8_t> image = gradient(97, 71);
  for (const ImageKind kind : {ImageKind::kJpeg, ImageKind::kWebp}) {
    std::size_t size = 0;
    double error = 1e9;
    for (const int quality : {20, 60, 98}) {
      const Result<std::string> bytes = encode_image(image, {.kind = kind, .quality = quality});
      ASSERT_TRUE(bytes) << bytes.error().message;
      const auto read = decode_image8(*bytes, kind, "it");
      ASSERT_TRUE(read) << read.error().message;
      double sum = 0;
      for (std::size_t i = 0; i < image.values.size(); ++i) {
        sum += std::abs(int{image.values[i]} - int{read->values[i]});
      }
      EXPECT_GT(bytes->size(), size) << name_of(kind) << quality;
      EXPECT_LT(sum, error) << name_of(kind) << quality;
      size = bytes->size();
      error = sum;
    }
    EXPECT_LT(error / static_cast<double>(image.values.size()), 2.5) << name_of(kind);
  }
}

TEST(ImageWriter, TheBytesFollowFromThePixelsAlone) {
  const Image<std::uint8_t> image = gradient(33, 20);
  std::vector<ImageEncoding> encodings = lossless_encodings();
  encodings.push_back({.kind = ImageKind::kJpeg});
  encodings.push_back({.kind = ImageKind::kWebp});
  for (const ImageEncoding& encoding : encodings) {
    const Result<std::string> once = encode_image(image, encoding);
    ASSERT_TRUE(once);
    EXPECT_EQ(*encode_image(image, encoding), *once);
    EXPECT_EQ(once->find("OpenImageIO"), std::string::npos) << name_of(encoding.kind);
    EXPECT_EQ(once->find("20"
                         "26:"),
              std::string::npos)
        << name_of(encoding.kind);
  }
}

TEST(ImageWriter, ATiffSaysThatItsDateIsUnknown) {
  const Result<std::string> bytes = encode_image(gradient(8, 8), {.kind = ImageKind::kTiff});
  ASSERT_TRUE(bytes);
  EXPECT_NE(bytes->find("    :  :     :  :  "), std::string::npos);
}

TEST(ImageWriter, WhatAKindCannotHoldIsAnErrorThatSaysSo) {
  const Image<std::uint8_t> wide(16'384, 1, 3);
  const auto webp = encode_image(wide, {.kind = ImageKind::kWebp});
  ASSERT_FALSE(webp);
  EXPECT_EQ(webp.error().kind, ErrorKind::kInput);
  EXPECT_EQ(webp.error().message, "a WebP has at most 16383 pixels a side, not 16384 × 1");
  const auto exr = encode_image(wide, {.kind = ImageKind::kExr});
  ASSERT_FALSE(exr);
  EXPECT_EQ(exr.error().kind, ErrorKind::kInput);
}

}  // namespace
}  // namespace seedframe
