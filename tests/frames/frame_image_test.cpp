#include "frames/frame_image.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "frames/campaign_files.h"
#include "image_files/image_writer.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FrameImageTest : public ::testing::TestWithParam<ImageEncoding> {
 protected:
  void SetUp() override {
    std::string pattern = (fs::path(::testing::TempDir()) / "frame_image-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    for (std::size_t i = 0; i < image_.values.size(); ++i) {
      image_.values[i] = static_cast<std::uint8_t>(i * i / 60);
    }
    const auto bytes = encode_image(image_, GetParam());
    ASSERT_TRUE(bytes) << bytes.error().message;
    bytes_ = *bytes;
    write(bytes_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& bytes) {
    ASSERT_TRUE(write_file(folder_ / frame_files::image(GetParam().format), bytes));
  }
  Result<Image<std::uint8_t>> read() const { return read_frame_image(folder_, GetParam().format); }

  fs::path folder_;
  Image<std::uint8_t> image_{40, 30, 3};
  std::string bytes_;
};

INSTANTIATE_TEST_SUITE_P(Encodings, FrameImageTest,
                         ::testing::Values(ImageEncoding{}, ImageEncoding{.compression = 6},
                                           ImageEncoding{.format = ImageFormat::kJpeg},
                                           ImageEncoding{.format = ImageFormat::kWebp},
                                           ImageEncoding{.format = ImageFormat::kTiff}),
                         [](const auto& test) {
                           std::string name = describe(test.param);
                           std::erase_if(name, [](char c) {
                             return std::isalnum(static_cast<unsigned char>(c)) == 0;
                           });
                           return name;
                         });

TEST_P(FrameImageTest, IsReadAsItWasWritten) {
  const auto image = read();
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 40);
  EXPECT_EQ(image->height, 30);
  EXPECT_EQ(image->channels, 3);
  EXPECT_EQ(image->values == image_.values, !is_lossy(GetParam()));
}

TEST_P(FrameImageTest, AMissingOrCutOneIsCorruptAndNamed) {
  for (const std::size_t bytes : {bytes_.size() / 2, std::size_t{10}, std::size_t{0}}) {
    write(bytes_.substr(0, bytes));
    const auto image = read();
    ASSERT_FALSE(image) << bytes;
    EXPECT_EQ(image.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(image.error().message, HasSubstr(frame_files::image(GetParam().format)));
  }
  fs::remove(folder_ / frame_files::image(GetParam().format));
  const auto image = read();
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(image.error().message, HasSubstr(frame_files::image(GetParam().format)));
}

TEST_P(FrameImageTest, AnotherFormatUnderItsNameIsCorrupt) {
  const bool jpeg = GetParam().format == ImageFormat::kJpeg;
  write(*encode_image(image_, {.format = jpeg ? ImageFormat::kTiff : ImageFormat::kJpeg}));
  const auto image = read();
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().kind, ErrorKind::kCorrupt);
}

}  // namespace
}  // namespace seedframe
