#include "image_files/image_kind.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

using namespace std::string_view_literals;

TEST(ImageKind, FollowsFromTheEndingWhateverItsCase) {
  EXPECT_EQ(image_kind_of("a/b.PNG"), ImageKind::kPng);
  EXPECT_EQ(image_kind_of("b.jpeg"), ImageKind::kJpeg);
  EXPECT_EQ(image_kind_of("b.Jpg"), ImageKind::kJpeg);
  EXPECT_EQ(image_kind_of("b.tif"), ImageKind::kTiff);
  EXPECT_EQ(image_kind_of("b.x.hdr"), ImageKind::kHdr);
  EXPECT_EQ(image_kind_of("b.gif"), std::nullopt);
  EXPECT_EQ(image_kind_of("png"), std::nullopt);
  EXPECT_EQ(image_kind_of(".png"), std::nullopt);
  EXPECT_EQ(image_kind_of("b.png.part"), std::nullopt);
}

TEST(ImageKind, BytesThatAreNoImageAreNamed) {
  EXPECT_EQ(what_bytes_look_like(""), "empty");
  EXPECT_EQ(what_bytes_look_like("version https://git-lfs.github.com/spec/v1\noid sha256:00"),
            "a Git LFS pointer: 'git lfs pull' fetches the file itself");
  EXPECT_EQ(what_bytes_look_like("\n <!DOCTYPE HTML PUBLIC"),
            "an HTML page: the download went wrong");
  EXPECT_EQ(what_bytes_look_like("<html lang=\"en\">"), "an HTML page: the download went wrong");
  EXPECT_EQ(what_bytes_look_like("\0\0\0\0"sv), "full of zeros");
  EXPECT_EQ(what_bytes_look_like("\xff\xd8\xff\xe0"sv), "a JPEG");
  EXPECT_EQ(what_bytes_look_like("RIFF"sv), "");
  EXPECT_EQ(what_bytes_look_like("RIFF\0\0\0\0WEBPVP8 "sv), "a WebP");
  EXPECT_EQ(what_bytes_look_like("hello"), "");
}

}  // namespace
}  // namespace seedframe
