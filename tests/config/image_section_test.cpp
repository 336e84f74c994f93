// The section `image`, as far as it says into which file a picture goes.

#include "config/image_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::HasSubstr;

Result<CampaignConfig> read_picture(const std::string& more,
                                    const std::vector<Override>& overrides = {}) {
  return read_campaign_config("seedframe: 1\ncamera: {distance_m: 1}\n" + more, "i.yaml",
                              overrides);
}

ImageEncoding encoding_of(const std::string& section) {
  const auto config = read_picture("image: " + section + "\n");
  EXPECT_TRUE(config) << config.error().message;
  return config ? config->image.encoding : ImageEncoding{.quality = -1};
}

std::string picture_refusal_of(const std::string& more) {
  const auto config = read_picture(more);
  return config ? "(no error)" : config.error().message;
}

TEST(ImageSection, IsPngUnlessSaidOtherwise) {
  EXPECT_EQ(read_picture("")->image.encoding, ImageEncoding{});
  EXPECT_EQ(encoding_of("{view: Standard}"), ImageEncoding{});
  EXPECT_EQ(encoding_of("{format: png}"), ImageEncoding{});
  EXPECT_EQ(ImageEncoding{}.format, ImageFormat::kPng);
}

TEST(ImageSection, NamesAFormatWithWhatItKnows) {
  EXPECT_EQ(encoding_of("{format: jpeg}"),
            (ImageEncoding{.format = ImageFormat::kJpeg, .quality = 95}));
  EXPECT_EQ(encoding_of("{format: jpeg, quality: 60}"),
            (ImageEncoding{.format = ImageFormat::kJpeg, .quality = 60}));
  EXPECT_EQ(encoding_of("{format: webp, quality: 100}"),
            (ImageEncoding{.format = ImageFormat::kWebp, .quality = 100}));
  EXPECT_EQ(encoding_of("{format: png, compression: 0}"), (ImageEncoding{.compression = 0}));
  EXPECT_EQ(encoding_of("{compression: 9}"), (ImageEncoding{.compression = 9}));
  EXPECT_EQ(encoding_of("{format: tiff}"), (ImageEncoding{.format = ImageFormat::kTiff}));
  EXPECT_EQ(encoding_of("{format: tiff, compression: none}"),
            (ImageEncoding{.format = ImageFormat::kTiff, .tiff = TiffCompression::kNone}));
  EXPECT_EQ(encoding_of("{format: tiff, compression: lzw}"),
            (ImageEncoding{.format = ImageFormat::kTiff, .tiff = TiffCompression::kLzw}));
}

TEST(ImageSection, IsSetFromTheCommandLine) {
  const auto config = read_picture("image: {view: Standard}\n",
                                   {{"image.format", "jpeg"}, {"image.quality", "80"}});
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->image.encoding, (ImageEncoding{.format = ImageFormat::kJpeg, .quality = 80}));
  EXPECT_EQ(config->image.settings.view, "Standard");
}

TEST(ImageSection, ErrorsNameTheKey) {
  EXPECT_THAT(picture_refusal_of("image: {format: jpg}\n"),
              HasSubstr("i.yaml:3:17: image.format: expected one of png, jpeg, webp, tiff, found "
                        "'jpg'"));
  EXPECT_THAT(picture_refusal_of("image: {format: jpeg, quality: 0}\n"),
              HasSubstr("image.quality: "));
  EXPECT_THAT(picture_refusal_of("image: {format: jpeg, quality: 101}\n"),
              HasSubstr("image.quality: "));
  EXPECT_THAT(picture_refusal_of("image: {compression: 10}\n"), HasSubstr("image.compression: "));
  EXPECT_THAT(picture_refusal_of("image: {format: tiff, compression: 5}\n"),
              HasSubstr("image.compression: expected none, lzw or zip for a tiff, found '5'"));
}

TEST(ImageSection, RefusesWhatTheFormatDoesNotKnow) {
  EXPECT_THAT(picture_refusal_of("image: {quality: 80}\n"),
              HasSubstr("i.yaml:3:18: image.quality: quality is of jpeg and webp only, and the "
                        "format is png"));
  EXPECT_THAT(picture_refusal_of("image: {format: jpeg, compression: 6}\n"),
              HasSubstr("compression is of png and tiff only, and the format is jpeg"));
}

TEST(ImageSection, RefusesAWebpOfMorePixelsThanItHolds) {
  EXPECT_THAT(picture_refusal_of("render: {width: 16384}\nimage: {format: webp}\n"),
              HasSubstr("i.yaml:4:17: image.format: a webp has at most 16383 pixels a side"));
  EXPECT_EQ(picture_refusal_of("render: {width: 16383}\nimage: {format: webp}\n"), "(no error)");
  EXPECT_EQ(picture_refusal_of("render: {width: 16384}\nimage: {format: jpeg}\n"), "(no error)");
}

}  // namespace
}  // namespace seedframe
