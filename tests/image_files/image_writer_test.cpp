#include "image_files/image_writer.h"

#include <cstdlib>
#include <ctime>

#include <gtest/gtest.h>

#include "image/png_file.h"
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

ImageKind kind_of(ImageFormat format) {
  return *image_kind_of(std::string("x") + ending_of(format));
}

const std::vector<ImageEncoding>& lossless_encodings() {
  static const std::vector<ImageEncoding> kEncodings = {
      {},
      {.compression = 0},
      {.compression = 9},
      {.format = ImageFormat::kTiff, .tiff = TiffCompression::kNone},
      {.format = ImageFormat::kTiff, .tiff = TiffCompression::kLzw},
      {.format = ImageFormat::kTiff, .tiff = TiffCompression::kZip}};
  return kEncodings;
}

/// As dates in image files begin.
std::string this_month() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y:%m:", std::localtime(&now));
  return text;
}

TEST(ImageWriter, LosslessKindsGiveThePixelsBack) {
  const Image<std::uint8_t> image = gradient(97, 71);
  for (const ImageEncoding& encoding : lossless_encodings()) {
    const Result<std::string> bytes = encode_image(image, encoding);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto read = decode_image8(*bytes, kind_of(encoding.format), "it");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->width, 97);
    EXPECT_EQ(read->channels, 3);
    EXPECT_EQ(read->values, image.values) << describe(encoding);
  }
}

TEST(ImageWriter, JpegAndWebpAreCloserAndLargerWithMoreQuality) {
  const Image<std::uint8_t> image = gradient(97, 71);
  for (const ImageFormat format : {ImageFormat::kJpeg, ImageFormat::kWebp}) {
    std::size_t size = 0;
    double error = 1e9;
    for (const int quality : {20, 60, 98}) {
      const Result<std::string> bytes = encode_image(image, {.format = format, .quality = quality});
      ASSERT_TRUE(bytes) << bytes.error().message;
      const auto read = decode_image8(*bytes, kind_of(format), "it");
      ASSERT_TRUE(read) << read.error().message;
      double sum = 0;
      for (std::size_t i = 0; i < image.values.size(); ++i) {
        sum += std::abs(int{image.values[i]} - int{read->values[i]});
      }
      EXPECT_GT(bytes->size(), size) << name_of(format) << quality;
      EXPECT_LT(sum, error) << name_of(format) << quality;
      size = bytes->size();
      error = sum;
    }
    EXPECT_LT(error / static_cast<double>(image.values.size()), 2.5) << name_of(format);
  }
}

TEST(ImageWriter, TheBytesFollowFromThePixelsAlone) {
  const Image<std::uint8_t> image = gradient(33, 20);
  std::vector<ImageEncoding> encodings = lossless_encodings();
  encodings.push_back({.format = ImageFormat::kJpeg});
  encodings.push_back({.format = ImageFormat::kWebp});
  for (const ImageEncoding& encoding : encodings) {
    const Result<std::string> once = encode_image(image, encoding);
    ASSERT_TRUE(once);
    EXPECT_EQ(*encode_image(image, encoding), *once);
    EXPECT_EQ(once->find("OpenImageIO"), std::string::npos) << describe(encoding);
    EXPECT_EQ(once->find("tEXt"), std::string::npos) << describe(encoding);
    EXPECT_EQ(once->find(this_month()), std::string::npos) << describe(encoding);
  }
}

TEST(ImageWriter, ATiffSaysThatItsDateIsUnknown) {
  const Result<std::string> bytes = encode_image(gradient(8, 8), {.format = ImageFormat::kTiff});
  ASSERT_TRUE(bytes);
  EXPECT_NE(bytes->find("    :  :     :  :  "), std::string::npos);
}

TEST(ImageWriter, PngNeedsNoLibrary) {
  EXPECT_EQ(*encode_image(gradient(9, 8), {}), encode_png(gradient(9, 8)));
  EXPECT_LT(encode_image(gradient(97, 71), {.compression = 9})->size(),
            encode_image(gradient(97, 71), {.compression = 0})->size());
}

TEST(ImageWriter, CanBeAskedBeforehand) {
  EXPECT_TRUE(check_encoding({}));
  const Status jpeg = check_encoding({.format = ImageFormat::kJpeg});
  EXPECT_TRUE(jpeg) << jpeg.error().message;
}

TEST(ImageWriter, WhatAKindCannotHoldIsAnErrorThatSaysSo) {
  const Image<std::uint8_t> wide(16'384, 1, 3);
  const auto webp = encode_image(wide, {.format = ImageFormat::kWebp});
  ASSERT_FALSE(webp);
  EXPECT_EQ(webp.error().kind, ErrorKind::kInput);
  EXPECT_EQ(webp.error().message, "a webp has at most 16383 pixels a side, not 16384 × 1");
}

}  // namespace
}  // namespace seedframe
