// What seedframe takes for the pixels of a texture must be what Blender renders.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "assets/image_check.h"
#include "image_files/image_reader.h"
#include "tests/fixtures/all_image_kinds.h"
#include "tests/fixtures/real_blender.h"

namespace seedframe {
namespace {

using ::testing::StartsWith;
namespace fs = std::filesystem;

struct BlenderImage {
  std::string color_space;
  Image<float> rgb;  ///< as Cycles renders it
};

class RealBlenderReading : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / fmt::format("RealBlenderReading.{}", ::getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void add(const ImageFile& file, const std::string& use) {
    ASSERT_TRUE(write_file(folder_ / file.name, file.bytes));
    list_ += use + "\t" + (folder_ / file.name).string() + "\n";
  }

  void run_blender() {
    ASSERT_TRUE(write_file(folder_ / "list.txt", list_));
    const fs::path log = folder_ / "log.txt";
    ASSERT_EQ(run_in_blender(SEEDFRAME_HOME "/tests/assets/blender/read_images.py",
                             (folder_ / "list.txt").string(), log),
              0)
        << *read_file(log);
  }

  bool was_read(const std::string& name, const std::string& use) const {
    return fs::exists(folder_ / (name + "." + use));
  }

  BlenderImage result(const std::string& name, const std::string& use) const {
    const auto bytes = read_file(folder_ / (name + "." + use));
    EXPECT_TRUE(bytes) << "Blender cannot read " << name << ": " << *read_file(folder_ / "log.txt");
    if (!bytes) return {};
    std::istringstream head(bytes->substr(0, bytes->find('\n')));
    int width = 0;
    int height = 0;
    BlenderImage image;
    head >> width >> height >> std::ws;
    std::getline(head, image.color_space);
    image.rgb = Image<float>(width, height, 3);
    const std::size_t start = bytes->find('\n') + 1;
    EXPECT_EQ(bytes->size() - start, image.rgb.values.size() * sizeof(float)) << name;
    std::memcpy(image.rgb.values.data(), bytes->data() + start,
                std::min(bytes->size() - start, image.rgb.values.size() * sizeof(float)));
    return image;
  }

  /// The greatest difference of red, green and blue; one channel of `ours` stands for all three.
  static float difference(const Image<float>& ours, const Image<float>& rgb) {
    EXPECT_EQ(ours.width, rgb.width);
    EXPECT_EQ(ours.height, rgb.height);
    if (ours.width != rgb.width || ours.height != rgb.height) return INFINITY;
    float most = 0.0F;
    for (int row = 0; row < ours.height; ++row) {
      for (int column = 0; column < ours.width; ++column) {
        for (int c = 0; c < 3; ++c) {
          const float value = ours.at(row, column, ours.channels < 3 ? 0 : c);
          most = std::max(most, std::abs(value - rgb.at(row, column, c)));
        }
      }
    }
    return most;
  }

  fs::path folder_;
  std::string list_;
};

Image<float> gray_image() {
  Image<float> gray(32, 16, 1);
  for (std::size_t i = 0; i < gray.values.size(); ++i) {
    gray.values[i] = static_cast<float>(i % 7) * 0.125F;
  }
  return gray;
}

float linear_of(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

TEST_F(RealBlenderReading, EveryKindHasTheSamePixelsInBlender) {
  for (const ImageFile& file : all_image_kinds()) add(file, "data");
  run_blender();
  for (const ImageFile& file : all_image_kinds()) {
    const auto ours = decode_image(file.bytes, file.kind, file.name);
    ASSERT_TRUE(ours) << ours.error().message;
    const BlenderImage blender = result(file.name, "data");
    EXPECT_EQ(blender.color_space, "Non-Color") << file.name;
    EXPECT_LE(difference(*ours, blender.rgb), 1e-6F) << file.name;
  }
}

TEST_F(RealBlenderReading, ColoursAreLinearInExrAndHdrAndSrgbElsewhere) {
  for (const ImageFile& file : all_image_kinds()) add(file, "color");
  run_blender();
  for (const ImageFile& file : all_image_kinds()) {
    auto ours = decode_image(file.bytes, file.kind, file.name);
    ASSERT_TRUE(ours) << ours.error().message;
    const BlenderImage blender = result(file.name, "color");
    const bool linear = file.kind == ImageKind::kExr || file.kind == ImageKind::kHdr;
    EXPECT_THAT(blender.color_space, StartsWith(linear ? "Linear" : "sRGB")) << file.name;
    if (!linear) {
      for (float& value : ours->values) value = linear_of(value);
    }
    EXPECT_LE(difference(*ours, blender.rgb), linear ? 1e-6F : 2e-4F) << file.name;
  }
}

TEST_F(RealBlenderReading, EnvironmentMapsHaveTheSamePixelsInBlender) {
  const Image<float> light = radiance_values(colorful_image(32, 16));
  Image<float> with_alpha(32, 16, 4);
  Image<float> with_depth(32, 16, 4);
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 32; ++column) {
      for (int c = 0; c < 3; ++c) {
        with_alpha.at(row, column, c) = light.at(row, column, c);
        with_depth.at(row, column, c) = light.at(row, column, c);
      }
      with_alpha.at(row, column, 3) = 0.5F;
      with_depth.at(row, column, 3) = 7.0F;
    }
  }
  const std::vector<ImageFile> files = {
      {"rgb.exr", ImageKind::kExr, exr_bytes(light, {"R", "G", "B"})},
      {"rgba.exr", ImageKind::kExr, exr_bytes(with_alpha, {"R", "G", "B", "A"})},
      {"rgbz.exr", ImageKind::kExr, exr_bytes(with_depth, {"R", "G", "B", "Z"})},
      {"exposure.hdr", ImageKind::kHdr,
       radiance_bytes(colorful_image(32, 16), {.more = "EXPOSURE=2\nGAMMA=1\n"})}};
  for (const ImageFile& file : files) add(file, "environment");
  run_blender();
  for (const ImageFile& file : files) {
    const BlenderImage blender = result(file.name, "environment");
    EXPECT_THAT(blender.color_space, StartsWith("Linear")) << file.name;
    EXPECT_LE(difference(light, blender.rgb), 1e-6F) << file.name;
  }
}

TEST_F(RealBlenderReading, AGrayTextureIsGray) {
  const ImageFile file = {"gray.exr", ImageKind::kExr, exr_bytes(gray_image(), {"Y"})};
  add(file, "data");
  run_blender();
  EXPECT_EQ(difference(gray_image(), result(file.name, "data").rgb), 0.0F);
}

/// Why they are refused: Blender renders them as something else, or not at all.
TEST_F(RealBlenderReading, WhatIsRefusedIsWhatBlenderMisreads) {
  const Image<std::uint8_t> colors = colorful_image(32, 16);
  const std::vector<ImageFile> files = {
      {"layers.exr", ImageKind::kExr,
       exr_bytes(radiance_values(colors), {"a.b.R", "a.b.G", "a.b.B"})},
      {"crlf.hdr", ImageKind::kHdr, radiance_bytes(colors, {.line_end = "\r\n"})},
      {"xyze.hdr", ImageKind::kHdr, radiance_bytes(colors, {.format = "32-bit_rle_xyze"})},
      {"turned.hdr", ImageKind::kHdr, radiance_bytes(colors, {.order = "-Y 16 -X 32"})}};
  for (const ImageFile& file : files) {
    EXPECT_FALSE(check_image(file.bytes, file.kind, ImageUse::kEnvironment, file.name))
        << file.name;
    add(file, "environment");
  }
  run_blender();
  EXPECT_FALSE(was_read("layers.exr", "environment"));
  EXPECT_FALSE(was_read("crlf.hdr", "environment"));
  if (was_read("xyze.hdr", "environment")) {  // not by later Blenders
    const Image<float> xyze = result("xyze.hdr", "environment").rgb;
    for (int c = 0; c < 3; ++c) EXPECT_EQ(xyze.at(8, 8, c), c == 1 ? 0.0F : 1.0F);  // magenta
  }
  // As if it were not turned.
  EXPECT_EQ(difference(radiance_values(colors), result("turned.hdr", "environment").rgb), 0.0F);
}

}  // namespace
}  // namespace seedframe
