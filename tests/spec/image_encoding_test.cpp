#include "spec/image_encoding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::HasSubstr;

const std::vector<std::pair<ImageEncoding, const char*>> kEncodings = {
    {{}, R"({"format":"png"})"},
    {{.compression = 6}, R"({"compression":6,"format":"png"})"},
    {{.format = ImageFormat::kJpeg, .quality = 80}, R"({"format":"jpeg","quality":80})"},
    {{.format = ImageFormat::kWebp}, R"({"format":"webp","quality":95})"},
    {{.format = ImageFormat::kTiff, .tiff = TiffCompression::kLzw},
     R"({"compression":"lzw","format":"tiff"})"},
};

TEST(ImageEncoding, IsWrittenAndReadTheSame) {
  for (const auto& [encoding, text] : kEncodings) {
    EXPECT_EQ(canonical_json(to_json(encoding)), text);
    const auto read = image_encoding_from_json(*parse_json(text, ""), "m");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, encoding) << text;
  }
}

TEST(ImageEncoding, AnUnknownOneIsCorrupt) {
  for (const char* text :
       {R"({"format":"avif"})", R"({"format":"jpeg"})", R"({"format":"jpeg","quality":"best"})",
        R"({"format":"tiff","compression":"jpeg"})", R"({"format":3})", "[]", "3", "{}"}) {
    const auto read = image_encoding_from_json(*parse_json(text, ""), "m.json");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(read.error().message, HasSubstr("m.json")) << text;
  }
}

TEST(ImageEncoding, SaysWhetherPixelsComeBack) {
  EXPECT_FALSE(is_lossy({}));
  EXPECT_FALSE(is_lossy({.format = ImageFormat::kTiff}));
  EXPECT_TRUE(is_lossy({.format = ImageFormat::kWebp, .quality = 100}));
  EXPECT_TRUE(is_lossy({.format = ImageFormat::kJpeg, .quality = 100}));
}

TEST(ImageEncoding, IsDescribedInAFewWords) {
  EXPECT_EQ(describe(ImageEncoding{}), "png");
  EXPECT_EQ(describe({.format = ImageFormat::kJpeg, .quality = 80}), "jpeg, quality 80");
  EXPECT_EQ(describe({.format = ImageFormat::kWebp}), "webp, quality 95");
  EXPECT_EQ(describe({.format = ImageFormat::kTiff}), "tiff, compression zip");
}

TEST(ImageEncoding, EndsAsItsReadersExpect) {
  EXPECT_STREQ(ending_of(ImageFormat::kPng), ".png");
  EXPECT_STREQ(ending_of(ImageFormat::kJpeg), ".jpg");
  EXPECT_STREQ(ending_of(ImageFormat::kWebp), ".webp");
  EXPECT_STREQ(ending_of(ImageFormat::kTiff), ".tif");
}

}  // namespace
}  // namespace seedframe
