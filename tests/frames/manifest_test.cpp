#include "frames/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "base/sha256.h"
#include "frames/campaign_files.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kImage = "image.png";

class ManifestTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_file(folder_ / kImage, "pixels"));
    ASSERT_TRUE(write_file(folder_ / frame_files::kLabels, "{}"));
    manifest_.frame_id = std::string(64, 'f');
    manifest_.pixel_hashes = {{"combined", std::string(64, 'a')}, {"image", std::string(64, 'b')}};
    manifest_.files = {{kImage, {6, sha256_hex("pixels")}},
                       {frame_files::kLabels, {2, sha256_hex("{}")}}};
    text_ = readable_json(to_json(manifest_));
    ASSERT_TRUE(write_file(folder_ / frame_files::kManifest, text_));
  }

  std::string error_of(VerifyDepth depth) const {
    const auto verified = verify_frame(folder_, manifest_.frame_id, depth);
    return message_of(verified);
  }

  ScratchFolder folder_;
  Manifest manifest_;
  std::string text_;
};

TEST_F(ManifestTest, AFrameAsItWasWrittenIsGood) {
  const auto verified = verify_frame(folder_, manifest_.frame_id, VerifyDepth::kContents);
  ASSERT_TRUE(verified) << verified.error().message;
  EXPECT_EQ(verified->pixel_hash(), manifest_.pixel_hash());
}

TEST_F(ManifestTest, ThePixelHashIsOfThePassesOnly) {
  Manifest other = manifest_;
  other.files.clear();
  other.frame_id = "x";
  EXPECT_EQ(other.pixel_hash(), manifest_.pixel_hash());
  other.pixel_hashes["combined"][0] = 'c';
  EXPECT_NE(other.pixel_hash(), manifest_.pixel_hash());
}

TEST_F(ManifestTest, EveryTruncationIsAnError) {
  // The last byte is a newline, without which the text is still whole.
  for (std::size_t size = 0; size + 1 < text_.size(); ++size) {
    ASSERT_TRUE(write_file(folder_ / frame_files::kManifest, text_.substr(0, size)));
    ASSERT_FALSE(verify_frame(folder_, manifest_.frame_id, VerifyDepth::kSizes)) << size;
  }
}

TEST_F(ManifestTest, NamesTheFileThatIsNotAsItWas) {
  ASSERT_TRUE(write_file(folder_ / kImage, "pixelz"));
  EXPECT_EQ(error_of(VerifyDepth::kSizes), "(no error)");
  EXPECT_THAT(error_of(VerifyDepth::kContents), HasSubstr("image.png has changed"));
  ASSERT_TRUE(write_file(folder_ / kImage, "pixel"));
  EXPECT_THAT(error_of(VerifyDepth::kSizes), HasSubstr("image.png has 5 bytes instead of 6"));
  fs::remove(folder_ / kImage);
  EXPECT_THAT(error_of(VerifyDepth::kSizes), HasSubstr("image.png is missing"));
}

TEST_F(ManifestTest, AnotherFramesFolderIsNotThisFrame) {
  const auto verified = verify_frame(folder_, std::string(64, 'e'), VerifyDepth::kSizes);
  ASSERT_FALSE(verified);
  EXPECT_THAT(verified.error().message, HasSubstr("holds another frame"));
}

TEST_F(ManifestTest, SaysHowThePictureIsEncodedUnlessItIsPlainPng) {
  EXPECT_THAT(text_, Not(HasSubstr("\"image\": {")));
  EXPECT_EQ(manifest_.image_file(), "image.png");
  manifest_.image = {.format = ImageFormat::kJpeg, .quality = 80};
  const auto read = parse_manifest(readable_json(to_json(manifest_)), "m");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->image, manifest_.image);
  EXPECT_EQ(read->image_file(), "image.jpg");
  EXPECT_EQ(read->pixel_hash(), manifest_.pixel_hash()) << "the pixels are the same";
  const auto plain = parse_manifest(text_, "m");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->image, ImageEncoding{});
}

TEST_F(ManifestTest, APictureIsAsWantedOrThereIsNone) {
  const ImageEncoding jpeg{.format = ImageFormat::kJpeg};
  EXPECT_TRUE(manifest_.picture_is({}));
  EXPECT_FALSE(manifest_.picture_is(jpeg));
  EXPECT_FALSE(manifest_.picture_is({.compression = 6}));
  manifest_.pixel_hashes.erase("image");
  EXPECT_TRUE(manifest_.picture_is(jpeg));
}

TEST_F(ManifestTest, AnEncodingThatIsNotKnownIsRefused) {
  Json json = to_json(manifest_);
  json["image"] = {{"format", "avif"}};
  ASSERT_TRUE(write_file(folder_ / frame_files::kManifest, canonical_json(json)));
  EXPECT_THAT(error_of(VerifyDepth::kSizes), HasSubstr("'avif' is no format of images"));
}

TEST_F(ManifestTest, NewerVersionsAndPathsThatLeaveTheFolderAreRefused) {
  Json json = to_json(manifest_);
  json["version"] = 3;
  ASSERT_TRUE(write_file(folder_ / frame_files::kManifest, canonical_json(json)));
  EXPECT_THAT(error_of(VerifyDepth::kSizes), HasSubstr("is of version 3"));
  json["version"] = 2;
  json["files"]["../x"] = {{"bytes", 1}, {"sha256", ""}};
  ASSERT_TRUE(write_file(folder_ / frame_files::kManifest, canonical_json(json)));
  EXPECT_THAT(error_of(VerifyDepth::kSizes), HasSubstr("is not the name of a file"));
}

}  // namespace
}  // namespace seedframe
