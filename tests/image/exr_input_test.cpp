#include "image/exr_input.h"

#include <cstring>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "image/exr_file.h"
#include "image/exr_metadata.h"
#include "image/pass_reader.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/image/exr_writer.h"

namespace seedframe {
namespace {

using testing::HasSubstr;

std::string good_file(const ScratchFolder& folder) {
  blender_exr().write(folder / "good.exr");
  return *read_file(folder / "good.exr");
}

/// The attribute's value replaced and its length with it, or only its length.
std::string with_attribute(std::string bytes, const std::string& name_and_type,
                           std::uint32_t length, const std::string& value = "") {
  const std::size_t at = bytes.find(name_and_type) + name_and_type.size() + 1;
  std::uint32_t old = 0;
  std::memcpy(&old, bytes.data() + at, sizeof old);
  if (!value.empty()) bytes.replace(at + 4, old, value);
  std::memcpy(bytes.data() + at, &length, sizeof length);
  return bytes;
}

const std::string kCompression("compression\0compression", 23);
const std::string kChannels("channels\0chlist", 15);
const std::string kDataWindow("dataWindow\0box2i", 16);

TEST(ExrInput, AFileOfOpenExrHasNoFault) {
  const ScratchFolder folder;
  const std::string bytes = good_file(folder);
  EXPECT_EQ(exr_header_fault(bytes), nullptr);
}

// OpenEXR would read one byte, and take what follows for the next attribute.
TEST(ExrInput, AnAttributeMustHaveTheLengthOfItsType) {
  const ScratchFolder folder;
  const std::string longer =
      with_attribute(good_file(folder), kCompression, 3, std::string(3, '\0'));
  EXPECT_THAT(exr_header_fault(longer), HasSubstr("length of its type"));
}

TEST(ExrInput, AListOfChannelsMustFillItsAttribute) {
  const ScratchFolder folder;
  const std::string bytes = good_file(folder);
  const std::string short_list = with_attribute(bytes, kChannels, 3, std::string("R\0\0", 3));
  EXPECT_THAT(exr_header_fault(short_list), HasSubstr("list of channels"));
  const std::string long_list = with_attribute(bytes, kChannels, 2, std::string("\0\0", 2));
  EXPECT_THAT(exr_header_fault(long_list), HasSubstr("list of channels"));
}

TEST(ExrInput, AnAttributeMustEndInTheFile) {
  const ScratchFolder folder;
  const std::string bytes = with_attribute(good_file(folder), kChannels, 0x7fffffff);
  EXPECT_THAT(exr_header_fault(bytes), HasSubstr("longer than the file"));
}

// 2 GB of pixels and more, of a file of a few hundred bytes: an error before there is memory.
TEST(ExrInput, MorePixelsThanAFileCanHoldAreRefused) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_exr(folder / "depth.exr", Image<float>(4, 3), {"Z"}));
  const std::string bytes = *read_file(folder / "depth.exr");
  for (const auto& [x, y] :
       {std::pair(30000, 30000), std::pair(1 << 29, 0), std::pair(3, 1 << 29),
        std::pair(1 << 30, 1 << 30), std::pair(std::numeric_limits<int>::max(), 1)}) {
    const std::array<int, 4> window = {0, 0, x, y};
    const std::string value(reinterpret_cast<const char*>(window.data()), sizeof window);
    ASSERT_TRUE(write_file(folder / "lie.exr", with_attribute(bytes, kDataWindow, 16, value)));
    EXPECT_EQ(read_exr_channel(folder / "lie.exr", "Z").error().kind, ErrorKind::kCorrupt);
    EXPECT_EQ(without_metadata(*read_file(folder / "lie.exr"), "lie.exr").error().kind,
              ErrorKind::kRender);
  }
}

// OpenEXR would take the missing half of every line from memory that nobody wrote.
TEST(ExrInput, BlocksMustHoldTheValuesOfTheirChannels) {
  const ScratchFolder folder;
  for (const auto compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION}) {
    ExrFile file = blender_exr(40, 40);
    file.compression = compression;
    file.write(folder / "passes.exr");
    const PassExpectation expected{
        .width = 40, .height = 40, .depth = true, .normal = true, .max_instance_id = 4};
    ASSERT_TRUE(read_passes(folder / "passes.exr", expected)) << compression;
    std::string bytes = *read_file(folder / "passes.exr");
    const std::string name("ViewLayer.Combined.A\0", 21);
    bytes[bytes.find(name) + name.size()] = '\2';  // its type: float instead of half
    ASSERT_TRUE(write_file(folder / "lie.exr", bytes));
    const auto read = read_passes(folder / "lie.exr", expected);
    ASSERT_FALSE(read) << compression;
    EXPECT_THAT(read.error().message, HasSubstr("damaged"));
  }
}

TEST(ExrInput, AFlatImageMayBeCompressedAsFarAsZipGoes) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_exr(folder / "flat.exr", Image<float>(2000, 2000), {"Z"}));
  EXPECT_TRUE(read_exr_channel(folder / "flat.exr", "Z"));
}

}  // namespace
}  // namespace seedframe
