#include "image/exr_blocks.h"

#include <cmath>

#include <OpenEXR/ImfInputFile.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "base/philox.h"
#include "image/image.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/image/exr_writer.h"

namespace seedframe {
namespace {

/// A channel of each type, of random values, half of them in runs.
ExrFile random_file(int width, int height, Imf::Compression compression) {
  ExrFile file;
  file.width = width;
  file.height = height;
  file.compression = compression;
  const PhiloxStream stream(1, "values");
  std::uint32_t draw = 0;
  const auto fill = [&](const char* name, Imf::PixelType type, double largest, bool whole) {
    file.fill(name, type, 0.0F);
    float run = 0.0F;
    for (float& value : file.channels.at(name).values) {
      if (stream.uniform({.attempt = draw++}) < 0.5) {
        const double drawn = (stream.uniform({.attempt = draw++}) - 0.5) * 2.0 * largest;
        run = static_cast<float>(whole ? std::floor(std::abs(drawn)) : drawn);
      }
      value = run;
    }
  };
  fill("a", Imf::FLOAT, 1e10, false);
  fill("b", Imf::HALF, 65504.0, false);
  fill("c", Imf::HALF, 6e-8, false);  // subnormal numbers
  fill("d", Imf::HALF, 1.0, false);
  fill("e", Imf::FLOAT, 200.0, true);
  return file;
}

struct Channels {
  std::vector<std::string> names;
  std::vector<Image<float>> images;
  Imf::FrameBuffer buffer;

  Channels(const ExrFile& file, const std::vector<std::string>& wanted) : names(wanted) {
    for (std::size_t i = 0; i < names.size(); ++i) images.emplace_back(file.width, file.height);
    for (std::size_t i = 0; i < names.size(); ++i) {
      buffer.insert(names[i],
                    Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(images[i].values.data()),
                               sizeof(float), sizeof(float) * file.width));
    }
  }
};

TEST(ExrBlocks, AreReadAsOpenExrReadsThem) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "image.exr";
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION}) {
    for (const auto& [width, height] : {std::pair(1, 1), {3, 2}, {37, 16}, {64, 17}, {101, 50}}) {
      const ExrFile written = random_file(width, height, compression);
      written.write(path);
      const Result<std::string> bytes = read_file(path);
      Imf::InputFile file(path.c_str());
      Channels theirs(written, {"a", "b", "c", "d", "e"});
      file.setFrameBuffer(theirs.buffer);
      file.readPixels(0, height - 1);
      Channels ours(written, theirs.names);
      ASSERT_EQ(read_exr_blocks(*bytes, file.header(), ours.buffer), nullptr);
      for (std::size_t i = 0; i < ours.names.size(); ++i) {
        EXPECT_EQ(ours.images[i].values, theirs.images[i].values)
            << ours.names[i] << " of " << width << " x " << height << ", compression "
            << compression;
      }
    }
  }
}

TEST(ExrBlocks, OfSomeChannelsTheOthersAreCheckedToo) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "image.exr";
  const ExrFile written = random_file(37, 20, Imf::ZIP_COMPRESSION);
  written.write(path);
  std::string bytes = *read_file(path);
  const Imf::InputFile file(path.c_str());
  Channels ours(written, {"d"});
  ASSERT_EQ(read_exr_blocks(bytes, file.header(), ours.buffer), nullptr);
  for (std::size_t i = 0; i < ours.images[0].values.size(); ++i) {
    ASSERT_EQ(ours.images[0].values[i],
              static_cast<float>(half(written.channels.at("d").values[i])));
  }
  bytes.pop_back();
  EXPECT_STREQ(read_exr_blocks(bytes, file.header(), ours.buffer), "it ends in a block of lines");
  bytes.push_back('\0');
  bytes[bytes.size() - 200] ^= 1;
  EXPECT_STREQ(read_exr_blocks(bytes, file.header(), ours.buffer),
               "a block of lines does not hold the values of its channels");
}

}  // namespace
}  // namespace seedframe
