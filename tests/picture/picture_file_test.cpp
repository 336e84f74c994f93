#include "picture/picture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "image/png_file.h"
#include "image_files/image_reader.h"
#include "tests/fixtures/image_bytes.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

TEST(PictureFile, HasThePixelsAndTheSameBytesAgain) {
  const ScratchFolder folder;
  const Image<std::uint8_t> image = colorful_image(31, 17);
  ASSERT_TRUE(write_picture(image, folder / "a.png", false));
  ASSERT_TRUE(write_picture(image, folder / "b.png", false));
  ASSERT_TRUE(write_picture(image, folder / "a.jpg", false));
  EXPECT_EQ(read_png8(folder / "a.png")->values, image.values);
  EXPECT_EQ(*read_file(folder / "a.png"), *read_file(folder / "b.png"));
  const auto jpeg = decode_image8(*read_file(folder / "a.jpg"), ImageKind::kJpeg, "a.jpg");
  ASSERT_TRUE(jpeg) << jpeg.error().message;
  EXPECT_EQ(jpeg->width, 31);
}

TEST(PictureFile, OfOursIsReplacedAndOfOthersOnlyWhenAsked) {
  const ScratchFolder folder;
  const Image<std::uint8_t> first = colorful_image(8, 8), second = colorful_image(9, 9);
  for (const char* name : {"a.png", "a.jpg"}) {
    ASSERT_TRUE(write_picture(first, folder / name, false));
    EXPECT_TRUE(write_picture(second, folder / name, false)) << name;
    ASSERT_TRUE(write_file(folder / name, "somebody's"));
    EXPECT_THAT(message_of(write_picture(first, folder / name, false)), HasSubstr("--overwrite"));
    EXPECT_EQ(*read_file(folder / name), "somebody's");
    EXPECT_TRUE(write_picture(first, folder / name, true));
  }
}

TEST(PictureFile, IsNotWrittenWhereItCannotBe) {
  const ScratchFolder folder;
  const Image<std::uint8_t> image = colorful_image(8, 8);
  EXPECT_THAT(message_of(write_picture(image, folder / "a.bmp", false)), HasSubstr(".png or .jpg"));
  EXPECT_THAT(message_of(write_picture(image, folder / "a", false)), HasSubstr(".png or .jpg"));
  EXPECT_FALSE(write_picture(image, folder / "no/such/folder.png", false));
  std::filesystem::create_directory(folder / "b.png");
  EXPECT_THAT(message_of(write_picture(image, folder / "b.png", true)), HasSubstr("no file"));
  std::filesystem::create_symlink(folder / "target.png", folder / "c.png");
  EXPECT_FALSE(write_picture(image, folder / "c.png", true));
  EXPECT_FALSE(std::filesystem::exists(folder / "target.png"));
}

}  // namespace
}  // namespace seedframe
