#include "image_files/image_reader.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/all_image_kinds.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

std::string error_of(std::string_view bytes, ImageKind kind) {
  const auto header = visit_image(bytes, kind, "x");
  if (header) return "(no error)";
  EXPECT_EQ(header.error().kind, ErrorKind::kInput);
  return header.error().message;
}

TEST(ImageReader, LosslessKindsOf8BitsGiveTheirPixels) {
  const Image<std::uint8_t> colors = colorful_image(29, 17);
  for (const ImageFile& file : all_image_kinds()) {
    const bool lossy = file.kind == ImageKind::kJpeg || file.kind == ImageKind::kWebp;
    if (file.name.find("rgb8") == std::string::npos || lossy) continue;
    const auto read = decode_image8(file.bytes, file.kind, file.name);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->values, colors.values) << file.name;
  }
}

TEST(ImageReader, IntegersOf16BitsBecomeNumbersFrom0To1) {
  const auto png = decode_image(encode_png(deep_gray(29, 17)), ImageKind::kPng, "x");
  ASSERT_TRUE(png) << png.error().message;
  const auto tiff = decode_image(tiff_bytes(deep_colors(29, 17)), ImageKind::kTiff, "x");
  ASSERT_TRUE(tiff) << tiff.error().message;
  for (std::size_t i = 0; i < png->values.size(); ++i) {
    ASSERT_FLOAT_EQ(png->values[i], static_cast<float>(deep_gray(29, 17).values[i]) / 65535.0F);
  }
  for (std::size_t i = 0; i < tiff->values.size(); ++i) {
    ASSERT_FLOAT_EQ(tiff->values[i], static_cast<float>(deep_colors(29, 17).values[i]) / 65535.0F);
  }
}

TEST(ImageReader, FloatsComeAsTheyAreStored) {
  const Image<std::uint8_t> colors = colorful_image(29, 17);
  const Image<float> expected = radiance_values(colors);
  for (const ImageFile& file : all_image_kinds()) {
    if (file.kind != ImageKind::kHdr && file.kind != ImageKind::kExr) continue;
    const auto read = decode_image(file.bytes, file.kind, file.name);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->values, expected.values) << file.name;
  }
}

TEST(ImageReader, TheHeaderSaysWhatIsStored) {
  Image<float> values(3, 2, 2);
  const auto header = visit_image(exr_bytes(values, {"a.X", "b"}), ImageKind::kExr, "x");
  ASSERT_TRUE(header) << header.error().message;
  EXPECT_EQ(header->width, 3);
  EXPECT_EQ(header->height, 2);
  EXPECT_TRUE(header->is_float());
  EXPECT_THAT(header->channels, UnorderedElementsAre("a.X", "b"));
  EXPECT_FALSE(header->has_more_images);
  const auto pages = visit_image(tiff_bytes(deep_gray(4, 4), 1, 2), ImageKind::kTiff, "x");
  ASSERT_TRUE(pages) << pages.error().message;
  EXPECT_TRUE(pages->has_more_images);
}

TEST(ImageReader, ItIsTheNameThatChoosesTheReader) {
  for (const ImageFile& file : all_image_kinds()) {
    for (const ImageKind kind :
         {ImageKind::kPng, ImageKind::kJpeg, ImageKind::kTiff, ImageKind::kExr, ImageKind::kHdr,
          ImageKind::kWebp, ImageKind::kTga, ImageKind::kBmp}) {
      if (kind == file.kind) continue;
      EXPECT_NE(error_of(file.bytes, kind), "(no error)") << file.name << name_of(kind);
    }
  }
  EXPECT_EQ(error_of(encode_png(colorful_image(4, 4)), ImageKind::kJpeg),
            "x is no JPEG: it is a PNG");
}

TEST(ImageReader, WhatIsNoImageIsNamed) {
  for (const ImageKind kind : {ImageKind::kPng, ImageKind::kTga, ImageKind::kHdr}) {
    EXPECT_THAT(error_of("", kind), HasSubstr("it is empty"));
    EXPECT_THAT(error_of("version https://git-lfs.github.com/spec/v1\n", kind),
                HasSubstr("it is a Git LFS pointer"));
    EXPECT_THAT(error_of("<!DOCTYPE html><html>", kind), HasSubstr("it is an HTML page"));
  }
  EXPECT_EQ(error_of("gibberish", ImageKind::kPng), "x is no PNG: it begins like none");
}

/// Every length of a small file, or a sample of them.
TEST(ImageReader, ACutFileIsAnErrorOrHasAllOfItsPixels) {
  for (const ImageFile& file : all_image_kinds()) {
    const auto whole = decode_image(file.bytes, file.kind, "x");
    ASSERT_TRUE(whole) << file.name << whole.error().message;
    const std::size_t step = std::max<std::size_t>(1, file.bytes.size() / 300);
    for (std::size_t size = 0; size < file.bytes.size(); size += step) {
      const std::string cut = file.bytes.substr(0, size);
      const auto read = decode_image(cut, file.kind, "x");
      if (read) {
        ASSERT_EQ(read->values, whole->values) << file.name << " cut to " << size;
      } else {
        ASSERT_EQ(read.error().kind, ErrorKind::kInput) << file.name << " cut to " << size;
      }
    }
  }
}

TEST(ImageReader, ADamagedFileIsReadOrRefusedButNeverEndsTheProgram) {
  for (const ImageFile& file : all_image_kinds()) {
    std::uint32_t state = 1;
    const auto next = [&state] { return state = state * 1664525U + 1013904223U, state >> 8; };
    for (int round = 0; round < 300; ++round) {
      std::string damaged = file.bytes;
      for (int i = 0; i < 3; ++i) {
        // Most damage goes to the front, where headers are.
        const std::size_t reach =
            round % 2 == 0 ? std::min<std::size_t>(damaged.size(), 128) : damaged.size();
        damaged[next() % reach] = static_cast<char>(next());
      }
      const auto read = decode_image(damaged, file.kind, "x", {.side_px = 500, .pixels = 90'000});
      if (read) continue;
      EXPECT_EQ(read.error().kind, ErrorKind::kInput);
    }
  }
}

TEST(ImageReader, AJpegWhoseMiddleIsMissingIsRefused) {
  std::string jpeg = *encode_image(colorful_image(200, 200), {.format = ImageFormat::kJpeg});
  jpeg.erase(jpeg.size() / 2, jpeg.size() / 4);
  EXPECT_THAT(error_of(jpeg, ImageKind::kJpeg), HasSubstr("x is a damaged or cut JPEG"));
  jpeg.resize(jpeg.size() / 2);
  EXPECT_EQ(error_of(jpeg, ImageKind::kJpeg), "x is cut: a JPEG ends with an end marker");
}

TEST(ImageReader, APngWithoutItsEndIsRefused) {
  const std::string png = encode_png(colorful_image(20, 20));
  EXPECT_EQ(error_of(png.substr(0, png.size() - 1), ImageKind::kPng),
            "x is cut: a PNG ends with an end chunk");
  EXPECT_EQ(error_of(png + "appended", ImageKind::kPng), "(no error)");
}

TEST(ImageReader, WhatIsLargerThanTheLimitsIsRefusedBeforeItsPixelsAreDecoded) {
  const std::string hdr = radiance_head(70'000, 70'000);
  EXPECT_THAT(error_of(hdr, ImageKind::kHdr),
              StartsWith("x is too large: 70000 × 70000 pixels of 3 channels"));
  const std::string png = encode_png(colorful_image(20, 10));
  const auto small = visit_image(png, ImageKind::kPng, "x", {}, {.side_px = 19});
  ASSERT_FALSE(small);
  EXPECT_THAT(small.error().message, HasSubstr("x is too large"));
  EXPECT_FALSE(visit_image(png, ImageKind::kPng, "x", {}, {.pixels = 199}));
  EXPECT_TRUE(visit_image(png, ImageKind::kPng, "x", {}, {.side_px = 20, .pixels = 200}));
}

TEST(ImageReader, TheVisitorEndsTheReading) {
  const std::string png = encode_png(colorful_image(20, 200));
  int rows = 0;
  ImageVisit visit;
  visit.rows8 = [&](int, const Image<std::uint8_t>& some) -> Status {
    rows += some.height;
    return fail(ErrorKind::kInput, "enough");
  };
  const auto read = visit_image(png, ImageKind::kPng, "x", visit);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "enough");
  EXPECT_LT(rows, 200);
}

TEST(ImageReader, ARadianceFileThatReadersTakeDifferentlyIsRefused) {
  const Image<std::uint8_t> colors = colorful_image(16, 4);
  const auto error = [&](const RadianceText& text) {
    return error_of(radiance_bytes(colors, text), ImageKind::kHdr);
  };
  EXPECT_EQ(error({}), "(no error)");
  EXPECT_EQ(error({.more = "# made by hand\nEXPOSURE=1.0\n"}), "(no error)");
  EXPECT_THAT(error({.line_end = "\r\n"}), HasSubstr("CR LF"));
  EXPECT_THAT(error({.line_end = "\r"}), HasSubstr("no line FORMAT=32-bit_rle_rgbe"));
  EXPECT_THAT(error({.format = "32-bit_rle_xyze"}), HasSubstr("holds XYZE"));
  EXPECT_THAT(error({.order = "+Y 4 +X 16"}), HasSubstr("'+Y 4 +X 16'"));
  EXPECT_THAT(error({.order = "-Y 4 -X 16"}), HasSubstr("save it anew"));
  EXPECT_THAT(error({.order = "+X 16 -Y 4"}), HasSubstr("save it anew"));
  EXPECT_THAT(error({.order = "-Y -4 +X 16"}), HasSubstr("save it anew"));
}

}  // namespace
}  // namespace seedframe
