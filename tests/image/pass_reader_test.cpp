#include "image/pass_reader.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "image/pixel_hash.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/image/exr_writer.h"

namespace seedframe {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Key;
using testing::UnorderedElementsAre;

const PassExpectation kAllPasses{3, 2, true, true, 10};

class PassReader : public testing::Test {
 protected:
  Result<FramePasses> read(const ExrFile& file, const PassExpectation& expected = kAllPasses) {
    file.write(path_);
    return read_passes(path_, expected);
  }
  Result<FramePasses> read(std::string_view bytes, const PassExpectation& expected = kAllPasses) {
    EXPECT_TRUE(write_file(path_, bytes));
    return read_passes(path_, expected);
  }
  /// The message of a kRender error that names the file; fails the test if there is none.
  template <class File>
  std::string error_of(const File& file, const PassExpectation& expected = kAllPasses) {
    const Result<FramePasses> passes = read(file, expected);
    if (passes) {
      ADD_FAILURE() << "the file was accepted";
      return {};
    }
    EXPECT_EQ(passes.error().kind, ErrorKind::kRender);
    EXPECT_THAT(passes.error().message, HasSubstr("passes.exr"));
    return passes.error().message;
  }
  std::string bytes_of(const ExrFile& file) {
    file.write(path_);
    return *read_file(path_);
  }

  ScratchFolder folder_;
  std::filesystem::path path_ = folder_ / "passes.exr";
};

TEST_F(PassReader, ReadsSampleCountsWhereTheyAreAskedForAndHashesThemNever) {
  ExrFile file = blender_exr();
  file.fill("ViewLayer.Debug Sample Count.X", Imf::FLOAT, 0.25F);
  const auto without = read(file);
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_FALSE(without->sample_shares);
  PassExpectation expected = kAllPasses;
  expected.sample_counts = true;
  const auto with = read(file, expected);
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_EQ(with->sample_shares->at(1, 2, 0), 0.25F);
  EXPECT_EQ(with->pixel_hashes, without->pixel_hashes);
  EXPECT_THAT(error_of(blender_exr(), expected), HasSubstr("the sample count pass is missing"));
}

TEST_F(PassReader, ReadsEveryPassWithRowZeroOnTop) {
  ExrFile file = blender_exr();
  file.at("ViewLayer.Normal.X", 1, 2) = -0.5F;
  const auto passes = read(file);
  ASSERT_TRUE(passes) << passes.error().message;
  EXPECT_EQ(passes->combined.channels, 4);
  EXPECT_EQ(passes->combined.at(0, 2, 0), 0.5F);
  EXPECT_EQ(passes->combined.at(1, 0, 1), 0.5F);
  EXPECT_EQ(passes->combined.at(1, 2, 3), 1.0F);
  EXPECT_EQ(passes->instance_ids.values, (std::vector<std::uint16_t>{0, 1, 2, 3, 4, 0}));
  EXPECT_EQ(passes->depth->at(0, 0), 2.0F);
  EXPECT_EQ(passes->depth->at(1, 0), 3.0F);
  EXPECT_EQ(passes->normal->at(1, 2, 0), -0.5F);
  EXPECT_EQ(passes->normal->at(1, 2, 2), 1.0F);
}

TEST_F(PassReader, HashesThePixelsOfEachPass) {
  const auto passes = read(blender_exr());
  ASSERT_TRUE(passes) << passes.error().message;
  EXPECT_THAT(passes->pixel_hashes,
              UnorderedElementsAre(Key("combined"), Key("index"), Key("depth"), Key("normal")));
  EXPECT_EQ(passes->pixel_hashes.at("combined"), pixel_hash(passes->combined, "half", "R,G,B,A"));
  EXPECT_EQ(passes->pixel_hashes.at("index"), pixel_hash(passes->instance_ids, "X"));
  EXPECT_EQ(passes->pixel_hashes.at("depth"), pixel_hash(*passes->depth, "float", "Z"));
  EXPECT_EQ(passes->pixel_hashes.at("normal"), pixel_hash(*passes->normal, "float", "X,Y,Z"));
}

TEST_F(PassReader, TheHashDoesNotDependOnTheFile) {
  ExrFile file = blender_exr();
  const auto zip = read(file);
  file.compression = Imf::NO_COMPRESSION;
  const auto plain = read(file);
  ASSERT_TRUE(zip && plain);
  EXPECT_EQ(zip->pixel_hashes, plain->pixel_hashes);
}

TEST_F(PassReader, CombinedStoredAsFloatIsHashedAsFloat) {
  ExrFile file = blender_exr();
  for (const char* name : {"R", "G", "B", "A"}) {
    file.channels.at(std::string("ViewLayer.Combined.") + name).type = Imf::FLOAT;
  }
  const auto passes = read(file);
  ASSERT_TRUE(passes);
  EXPECT_EQ(passes->pixel_hashes.at("combined"), pixel_hash(passes->combined, "float", "R,G,B,A"));
}

TEST_F(PassReader, TheNameOfTheViewLayerDoesNotMatter) {
  for (const char* layer : {"", "Layer.", "My.View.Layer."}) {
    EXPECT_TRUE(read(blender_exr(3, 2, layer))) << layer;
  }
}

TEST_F(PassReader, ALaterBlenderMayCallTheIndexPassObjectIndex) {
  ExrFile file = blender_exr();
  file.channels["ViewLayer.Object Index.X"] = file.channels.at("ViewLayer.IndexOB.X");
  file.channels.erase("ViewLayer.IndexOB.X");
  EXPECT_TRUE(read(file));
}

TEST_F(PassReader, PassesThatWereNotAskedForMayBeMissing) {
  ExrFile file = blender_exr();
  for (const char* name : {"Depth.Z", "Normal.X", "Normal.Y", "Normal.Z"}) {
    file.channels.erase(std::string("ViewLayer.") + name);
  }
  const auto passes = read(file, {3, 2, false, false, 10});
  ASSERT_TRUE(passes) << passes.error().message;
  EXPECT_FALSE(passes->depth);
  EXPECT_FALSE(passes->normal);
}

TEST_F(PassReader, AMissingLayerIsNamedTogetherWithWhatThereIs) {
  ExrFile file = blender_exr();
  file.channels.erase("ViewLayer.Depth.Z");
  EXPECT_THAT(error_of(file), AllOf(HasSubstr("the depth pass is missing"), HasSubstr("Depth.Z"),
                                    HasSubstr("ViewLayer.IndexOB.X")));
}

TEST_F(PassReader, TwoLayersThatCouldBeThePassAreAnError) {
  ExrFile file = blender_exr();
  file.fill("Other.Combined.R", Imf::HALF, 1.0F);
  EXPECT_THAT(error_of(file), HasSubstr("two channels could be the combined pass: "
                                        "Other.Combined.R and ViewLayer.Combined.R"));
}

TEST_F(PassReader, AnotherFramesFileIsAnError) {
  PassExpectation expected = kAllPasses;
  expected.frame_id = std::string(64, 'a');
  ExrFile file = blender_exr();
  EXPECT_THAT(read(file, expected).error().message,
              HasSubstr("expected the passes of frame aaaaaaaaaaaa, found those of no frame"));
  file.note = std::string(64, 'b');
  EXPECT_THAT(read(file, expected).error().message, HasSubstr("found those of bbbbbbbbbbbb"));
  file.note = expected.frame_id;
  EXPECT_TRUE(read(file, expected));
}

TEST_F(PassReader, AnotherSizeIsAnError) {
  EXPECT_THAT(error_of(blender_exr(4, 2)), HasSubstr("expected 3 x 2 pixels, found 4 x 2"));
}

TEST_F(PassReader, AWindowThatDoesNotStartAtTheCornerIsAnError) {
  ExrFile file = blender_exr();
  file.first_column = 5;
  EXPECT_THAT(error_of(file), HasSubstr("found them from (5, 0)"));
}

TEST_F(PassReader, LossyCompressionIsAnError) {
  ExrFile file = blender_exr();
  file.compression = Imf::DWAA_COMPRESSION;
  EXPECT_THAT(error_of(file), HasSubstr("expected a lossless compression"));
}

TEST_F(PassReader, NaNAndInfinityAreErrorsThatNameThePixel) {
  ExrFile nan = blender_exr();
  nan.at("ViewLayer.Combined.G", 1, 2) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error_of(nan),
              HasSubstr("the combined pass has NaN in G of the pixel in row 1, column 2"));
  ExrFile infinite = blender_exr();
  infinite.at("ViewLayer.Depth.Z", 0, 1) = std::numeric_limits<float>::infinity();
  EXPECT_THAT(
      error_of(infinite),
      HasSubstr("the depth pass has an infinite value in Z of the pixel in row 0, column 1"));
}

TEST_F(PassReader, TheBackgroundsDepthIsANumber) {
  ExrFile file = blender_exr();
  file.at("ViewLayer.Depth.Z", 1, 1) = 1e10F;
  const auto passes = read(file);
  ASSERT_TRUE(passes) << passes.error().message;
  EXPECT_EQ(passes->depth->at(1, 1), 1e10F);
}

TEST_F(PassReader, AnIndexThatIsNotAnIdIsAnErrorThatNamesThePixel) {
  for (const float index : {1.5F, -1.0F, 11.0F, 70000.0F, 1e30F}) {
    ExrFile file = blender_exr();
    file.at("ViewLayer.IndexOB.X", 1, 0) = index;
    EXPECT_THAT(error_of(file),
                AllOf(HasSubstr("the index pass has "), HasSubstr("row 1, column 0"),
                      HasSubstr("a whole number from 0 to 10")));
  }
}

TEST_F(PassReader, TheLargestIndexOfBlenderIsRead) {
  ExrFile file = blender_exr();
  file.at("ViewLayer.IndexOB.X", 0, 0) = 32767.0F;
  const auto passes = read(file, {3, 2, true, true, 32767});
  ASSERT_TRUE(passes) << passes.error().message;
  EXPECT_EQ(passes->instance_ids.at(0, 0), 32767);
}

TEST_F(PassReader, AMissingFileIsARenderError) {
  const auto passes = read_passes(folder_ / "none.exr", kAllPasses);
  ASSERT_FALSE(passes);
  EXPECT_EQ(passes.error().kind, ErrorKind::kRender);
  EXPECT_THAT(passes.error().message, HasSubstr("none.exr"));
}

TEST_F(PassReader, AnEmptyFileAndGarbageAreErrors) {
  EXPECT_THAT(error_of(std::string()), HasSubstr("the file is empty"));
  EXPECT_THAT(error_of(std::string(5000, '\x5a')), HasSubstr("no OpenEXR file"));
  EXPECT_THAT(error_of(std::string(5000, '\0')), HasSubstr("no OpenEXR file"));
  EXPECT_THAT(error_of(std::string("\x76\x2f\x31\x01\x02\x00\x00\x00", 8) + std::string(500, 'x')),
              HasSubstr("passes.exr"));
}

TEST_F(PassReader, EveryTruncationIsAnError) {
  const std::string whole = bytes_of(blender_exr());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    ASSERT_FALSE(read(std::string_view(whole).substr(0, length))) << length;
  }
}

TEST_F(PassReader, TruncationsOfAFileWithManyBlocksAreErrors) {
  ExrFile file = blender_exr(40, 50);
  file.compression = Imf::NO_COMPRESSION;
  const std::string whole = bytes_of(file);
  for (std::size_t length = 0; length < whole.size(); length += 997) {
    ASSERT_FALSE(read(std::string_view(whole).substr(0, length), {40, 50, true, true, 10}))
        << length;
  }
}

TEST_F(PassReader, NoFlippedByteCrashesIt) {
  const std::string whole = bytes_of(blender_exr());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const unsigned char mask : {0x01, 0x80, 0xff}) {
      std::string flipped = whole;
      flipped[at] = static_cast<char>(static_cast<unsigned char>(flipped[at]) ^ mask);
      (void)read(flipped);
    }
  }
}

/// Offset of the value of an attribute of the header.
std::size_t value_offset(const std::string& bytes, const std::string& name,
                         const std::string& type) {
  const std::string key = name + '\0' + type + '\0';
  return bytes.find(key) + key.size() + 4;
}

TEST_F(PassReader, AHugeWindowIsRefusedBeforeItGetsMemory) {
  std::string lie = bytes_of(blender_exr());
  const std::size_t window = value_offset(lie, "dataWindow", "box2i");
  lie.replace(window + 8, 8, "\xff\xff\xff\x0f\xff\xff\xff\x0f");  // 268,435,456 squared
  error_of(lie);
  lie.replace(window + 12, 4, std::string("\x01\0\0\0", 4));  // that wide, two rows
  error_of(lie);
}

TEST_F(PassReader, AnAttributeLongerThanTheFileIsRefusedBeforeItGetsMemory) {
  std::string lie = bytes_of(blender_exr());
  lie.replace(value_offset(lie, "lineOrder", "lineOrder") - 4, 4, "\xff\xff\xff\x7f");
  EXPECT_THAT(error_of(lie), HasSubstr("an attribute is longer than the file"));
}

TEST_F(PassReader, TooManyChannelsAreRefused) {
  ExrFile file = blender_exr();
  for (int i = 0; i < 100; ++i) file.fill("Extra." + std::to_string(i), Imf::HALF, 0.0F);
  EXPECT_THAT(error_of(file), HasSubstr("at most 64 channels, found 109"));
}

TEST_F(PassReader, AFileFarTooLongIsNotRead) {
  EXPECT_THAT(error_of(std::string(2 << 20, 'x')), HasSubstr("too many for 3 x 2 pixels"));
}

}  // namespace
}  // namespace seedframe
