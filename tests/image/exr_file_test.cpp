#include "image/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

Image<float> ramp(int width, int height, int channels) {
  Image<float> image(width, height, channels);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<float>(i) / 7.0F - 3.0F;
  }
  return image;
}

std::vector<float> read_channel(const std::filesystem::path& path, const char* name) {
  Imf::InputFile file(path.c_str(), 0);
  const Imath::Box2i window = file.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x + 1);
  std::vector<float> values(width * static_cast<std::size_t>(window.max.y + 1));
  Imf::FrameBuffer buffer;
  buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                 sizeof(float) * width));
  file.setFrameBuffer(buffer);
  file.readPixels(0, window.max.y);
  return values;
}

TEST(ExrFile, ChannelsComeBackBitForBit) {
  const ScratchFolder folder;
  const Image<float> image = ramp(37, 21, 3);
  ASSERT_TRUE(write_exr(folder / "normal.exr", image, {"X", "Y", "Z"}));
  const std::vector<float> y = read_channel(folder / "normal.exr", "Y");
  ASSERT_EQ(y.size(), 37U * 21U);
  for (int row = 0; row < 21; ++row) {
    for (int column = 0; column < 37; ++column) {
      ASSERT_EQ(y[static_cast<std::size_t>(row * 37 + column)], image.at(row, column, 1));
    }
  }
}

TEST(ExrFile, ABackgroundOf1e10ComesBack) {
  const ScratchFolder folder;
  Image<float> depth(2, 1);
  depth.values = {1e10F, 2.5F};
  ASSERT_TRUE(write_exr(folder / "depth.exr", depth, {"Z"}));
  EXPECT_EQ(read_channel(folder / "depth.exr", "Z"), depth.values);
}

TEST(ExrFile, TheSamePixelsGiveTheSameBytesWithoutDateOrHost) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_exr(folder / "a.exr", ramp(16, 16, 1), {"Z"}));
  ASSERT_TRUE(write_exr(folder / "b.exr", ramp(16, 16, 1), {"Z"}));
  const std::string bytes = *read_file(folder / "a.exr");
  EXPECT_EQ(bytes, *read_file(folder / "b.exr"));
  for (const char* attribute : {"capDate", "owner", "comments", "software"}) {
    EXPECT_EQ(bytes.find(attribute), std::string::npos) << attribute;
  }
}

TEST(ExrFile, AFolderThatIsNotThereIsAnError) {
  const ScratchFolder folder;
  const Status written = write_exr(folder / "none" / "depth.exr", ramp(2, 2, 1), {"Z"});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(written.error().message, testing::HasSubstr("depth.exr"));
}

TEST(ExrFile, AFullDiskIsAnErrorEvenForTheLastBytes) {
  const Status written = write_exr("/dev/full", ramp(2, 2, 1), {"Z"});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kExhausted);
}

TEST(ExrFile, AChannelComesBack) {
  const ScratchFolder folder;
  Image<float> depth(7, 5);
  for (std::size_t i = 0; i < depth.values.size(); ++i)
    depth.values[i] = 0.1F * static_cast<float>(i);
  depth.values[3] = 1e10F;
  ASSERT_TRUE(write_exr(folder / "depth.exr", depth, {"Z"}));
  const auto read = read_exr_channel(folder / "depth.exr", "Z");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->width, 7);
  EXPECT_EQ(read->values, depth.values);
  EXPECT_EQ(read_exr_channel(folder / "depth.exr", "A").error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(read_exr_channel(folder / "none.exr", "Z").error().kind, ErrorKind::kCorrupt);
  const std::string bytes = *read_file(folder / "depth.exr");
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    ASSERT_TRUE(write_file(folder / "cut.exr", bytes.substr(0, length)));
    EXPECT_FALSE(read_exr_channel(folder / "cut.exr", "Z")) << length;
  }
}

}  // namespace
}  // namespace seedframe
