#include "assets/image_check.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/all_image_kinds.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::vector<std::string> kRgb = {"R", "G", "B"};

std::string fault(std::string_view bytes, ImageKind kind, ImageUse use) {
  const Status good = check_image(bytes, kind, use, "x");
  if (good) return "(good)";
  EXPECT_EQ(good.error().kind, ErrorKind::kInput);
  return good.error().message;
}

std::string fault_of_map(const Image<float>& image, const std::vector<std::string>& channels) {
  return fault(exr_bytes(image, channels), ImageKind::kExr, ImageUse::kEnvironment);
}

Image<float> with_value(float value) {
  Image<float> image = radiance_values(colorful_image(8, 100));
  image.at(90, 5, 1) = value;
  return image;
}

TEST(ImageCheck, EveryKindThatIsReadIsGoodWhereItsColoursAreUnderstood) {
  for (const ImageFile& file : all_image_kinds()) {
    EXPECT_EQ(fault(file.bytes, file.kind, ImageUse::kColor), "(good)") << file.name;
    EXPECT_EQ(fault(file.bytes, file.kind, ImageUse::kData), "(good)") << file.name;
    const bool linear = file.kind == ImageKind::kExr || file.kind == ImageKind::kHdr;
    EXPECT_EQ(fault(file.bytes, file.kind, ImageUse::kEnvironment),
              linear ? "(good)" : "x: an environment map is an .exr or .hdr file")
        << file.name;
  }
}

TEST(ImageCheck, AnEnvironmentMapHasRedGreenAndBlueInNoLayer) {
  const Image<float> three(8, 4, 3);
  EXPECT_EQ(fault_of_map(three, kRgb), "(good)");
  EXPECT_EQ(fault_of_map(Image<float>(8, 4, 4), {"R", "G", "B", "A"}), "(good)");
  EXPECT_THAT(fault_of_map(three, {"sky.R", "sky.G", "sky.B"}),
              HasSubstr("has its channels in layers, as sky."));
  EXPECT_THAT(fault_of_map(Image<float>(8, 4, 1), {"Y"}), HasSubstr("has luminance alone (Y)"));
  EXPECT_THAT(fault_of_map(Image<float>(8, 4, 1), {"Z"}), HasSubstr("has other channels"));
  EXPECT_THAT(fault_of_map(Image<float>(8, 4, 2), {"R", "G"}), HasSubstr("R, G and B are needed"));
}

TEST(ImageCheck, ATextureMayBeGray) {
  const std::string gray = exr_bytes(Image<float>(8, 4, 1), {"Y"});
  EXPECT_EQ(fault(gray, ImageKind::kExr, ImageUse::kData), "(good)");
  EXPECT_EQ(fault(gray, ImageKind::kExr, ImageUse::kColor), "(good)");
  const std::string subsampled = exr_bytes(Image<float>(8, 4, 3), {"Y", "RY", "BY"});
  EXPECT_THAT(fault(subsampled, ImageKind::kExr, ImageUse::kColor), HasSubstr("other channels"));
}

TEST(ImageCheck, LightIsFiniteAndNotNegative) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(fault_of_map(with_value(0.0F), kRgb), "(good)");
  EXPECT_EQ(fault_of_map(with_value(std::nanf("")), kRgb),
            "x has a value that is no number (NaN) in column 5 of row 90");
  EXPECT_EQ(fault_of_map(with_value(kInfinity), kRgb),
            "x has a value that is infinite in column 5 of row 90");
  EXPECT_EQ(fault_of_map(with_value(-kInfinity), kRgb),
            "x has a value that is infinite in column 5 of row 90");
  EXPECT_EQ(fault_of_map(with_value(-0.001F), kRgb),
            "x has a value that is negative in column 5 of row 90");
}

TEST(ImageCheck, DataMayBeNegativeButNotNothing) {
  const auto of = [](float value, ImageUse use) {
    return fault(exr_bytes(with_value(value), kRgb), ImageKind::kExr, use);
  };
  EXPECT_EQ(of(-0.5F, ImageUse::kData), "(good)");
  EXPECT_THAT(of(-0.5F, ImageUse::kColor), HasSubstr("negative"));
  EXPECT_THAT(of(std::nanf(""), ImageUse::kData), HasSubstr("NaN"));
}

TEST(ImageCheck, WhatBlenderWouldTakeForSomethingElseIsRefused) {
  EXPECT_EQ(fault(tiff_bytes(Image<float>(4, 4, 3), 3), ImageKind::kTiff, ImageUse::kColor),
            "x holds floats: save it as EXR, or with 8 or 16 bits");
  EXPECT_EQ(fault(tiff_bytes(deep_gray(4, 4), 1, 2), ImageKind::kTiff, ImageUse::kData),
            "x holds several images: save the one that is meant");
  EXPECT_THAT(fault(tiff_bytes(Image<std::uint32_t>(4, 4, 1)), ImageKind::kTiff, ImageUse::kData),
              HasSubstr("neither integers of 8 or 16 bits nor floats"));
}

TEST(ImageCheck, FilesMadeByHandEndInTheirErrors) {
  const fs::path folder = fs::path(SEEDFRAME_HOME) / "tests/fixtures/images";
  const auto fault_of_file = [&](const char* name) {
    return fault(*read_file(folder / name), *image_kind_of(name), ImageUse::kEnvironment);
  };
  EXPECT_THAT(fault_of_file("hdri/cut_flat.hdr"), HasSubstr("x is a damaged or cut Radiance file"));
  EXPECT_THAT(fault_of_file("hdri/no_pixels.hdr"), HasSubstr("x is no Radiance file"));
  EXPECT_THAT(fault_of_file("hdri/layered.exr"), HasSubstr("layers, as ViewLayer.Combined.R"));
  EXPECT_THAT(fault_of_file("hdri/luminance_only.exr"), HasSubstr("luminance alone (Y)"));
  EXPECT_THAT(fault_of_file("hdri/nan_pixel.exr"), HasSubstr("NaN"));
  EXPECT_THAT(fault(*read_file(folder / "jpgcut/x_Color.jpg"), ImageKind::kJpeg, ImageUse::kColor),
              HasSubstr("x is cut"));
}

const std::string kSomeHash(64, 'a');

TEST(CheckedImages, RemembersContentForOneUseOfOneKind) {
  const ScratchFolder folder;
  const CheckedImages checked(folder / "cache");
  EXPECT_FALSE(checked.is_known_good(kSomeHash, ImageKind::kExr, ImageUse::kData));
  checked.remember_good(kSomeHash, ImageKind::kExr, ImageUse::kData);
  EXPECT_TRUE(checked.is_known_good(kSomeHash, ImageKind::kExr, ImageUse::kData));
  EXPECT_TRUE(
      CheckedImages(folder / "cache").is_known_good(kSomeHash, ImageKind::kExr, ImageUse::kData));
  EXPECT_FALSE(checked.is_known_good(kSomeHash, ImageKind::kExr, ImageUse::kEnvironment));
  EXPECT_FALSE(checked.is_known_good(kSomeHash, ImageKind::kHdr, ImageUse::kData));
  EXPECT_FALSE(checked.is_known_good(std::string(64, 'b'), ImageKind::kExr, ImageUse::kData));
}

TEST(CheckedImages, WithoutAFolderNothingIsKnownAndNothingFails) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a_file", "x"));
  for (const fs::path& cache : {fs::path(), folder / "a_file", fs::path("/proc/none")}) {
    const CheckedImages checked(cache);
    checked.remember_good(kSomeHash, ImageKind::kPng, ImageUse::kColor);
    EXPECT_FALSE(checked.is_known_good(kSomeHash, ImageKind::kPng, ImageUse::kColor));
  }
}

}  // namespace
}  // namespace seedframe
