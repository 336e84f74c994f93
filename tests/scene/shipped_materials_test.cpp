// The library of textured materials, and folders that come beside it.

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "image_files/image_kind.h"
#include "image_files/image_reader.h"
#include "scene/material_library.h"
#include "scene/offered_images.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::Key;

MaterialLibrary shipped_library() {
  auto library = MaterialLibrary::open({kHome / "materials"}, {});
  EXPECT_TRUE(library) << library.error().message;
  return std::move(*library);
}

Image<float> pixels_of(const fs::path& file) {
  const auto bytes = read_file(file);
  EXPECT_TRUE(bytes);
  auto image = decode_image(*bytes, *image_kind_of(file), file.string());
  EXPECT_TRUE(image) << image.error().message;
  return std::move(*image);
}

/// Those that are no decals.
std::map<std::string, TextureSet> surfaces_of(const MaterialLibrary& library) {
  std::map<std::string, TextureSet> surfaces = library.texture_sets();
  std::erase_if(surfaces, [](const auto& entry) { return entry.second.is_decal; });
  return surfaces;
}

TEST(ShippedMaterials, AreMoreThanAHundredAndEachHasASizeInMetres) {
  const MaterialLibrary library = shipped_library();
  const auto surfaces = surfaces_of(library);
  EXPECT_EQ(surfaces.size(), 102U);
  for (const auto& [name, set] : surfaces) {
    const auto material = library.materials().find(name);
    ASSERT_NE(material, library.materials().end()) << name;
    ASSERT_TRUE(material->second.texture_size_m) << name << " has no texture_size_m";
  }
}

TEST(ShippedMaterials, HaveColorRoughnessAndNormalAndMetalsSayHowMetallicTheyAre) {
  const MaterialLibrary library = shipped_library();
  int with_metallic = 0;
  for (const auto& [name, set] : surfaces_of(library)) {
    for (const char* role : {"color", "roughness", "normal"}) {
      EXPECT_THAT(set.files, Contains(Key(role))) << name;
    }
    EXPECT_THAT(set.files, ::testing::Not(Contains(Key("alpha")))) << name;
    with_metallic += set.files.contains("metallic");
  }
  EXPECT_GE(with_metallic, 84);
}

/// The largest mean difference between neighbouring lines, and that between the first and the last.
struct Seam {
  double inside = 0.0;
  double across = 0.0;
};

Seam seam_of(const Image<float>& image, bool rows) {
  const int lines = rows ? image.height : image.width;
  const int length = rows ? image.width : image.height;
  const auto value = [&](int line, int i, int channel) {
    return rows ? image.at(line, i, channel) : image.at(i, line, channel);
  };
  const auto difference = [&](int a, int b) {
    double sum = 0.0;
    for (int i = 0; i < length; ++i) {
      for (int c = 0; c < image.channels; ++c) sum += std::abs(value(a, i, c) - value(b, i, c));
    }
    return sum / length / image.channels;
  };
  Seam seam;
  for (int line = 1; line < lines; ++line) {
    seam.inside = std::max(seam.inside, difference(line - 1, line));
  }
  seam.across = difference(lines - 1, 0);
  return seam;
}

TEST(ShippedMaterials, RepeatWithoutASeam) {
  constexpr double kEncoding = 0.012;  // of JPEG, whose blocks do not know of the next tile
  const MaterialLibrary library = shipped_library();
  for (const auto& [name, set] : surfaces_of(library)) {
    for (const auto& [role, file] : set.files) {
      const Image<float> image = pixels_of(file);
      EXPECT_GE(image.width, 256) << file;
      EXPECT_LE(image.width, 512) << file;
      for (const bool rows : {false, true}) {
        const Seam seam = seam_of(image, rows);
        EXPECT_LE(seam.across, seam.inside + kEncoding) << file.filename() << " rows: " << rows;
      }
    }
  }
}

TEST(ShippedMaterials, TheSeamThatIsLookedForIsFound) {
  Image<float> ramp(64, 64);
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) ramp.at(row, column) = column / 64.0F;
  }
  const Seam seam = seam_of(ramp, false);
  EXPECT_GT(seam.across, seam.inside + 0.5);
  EXPECT_LE(seam_of(ramp, true).across, 1e-9);
}

TEST(ShippedMaterials, NormalsPointOutwards) {
  const MaterialLibrary library = shipped_library();
  for (const auto& [name, set] : surfaces_of(library)) {
    const Image<float> image = pixels_of(set.files.at("normal"));
    ASSERT_GE(image.channels, 3) << name;
    double x = 0.0, y = 0.0, least_z = 1.0;
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        x += image.at(row, column, 0);
        y += image.at(row, column, 1);
        least_z = std::min<double>(least_z, image.at(row, column, 2));
      }
    }
    const double pixels = static_cast<double>(image.width) * image.height;
    EXPECT_NEAR(x / pixels, 0.5, 0.02) << name;
    EXPECT_NEAR(y / pixels, 0.5, 0.02) << name;
    EXPECT_GE(least_z, 0.5) << name;
  }
}

TEST(ShippedMaterials, ADownloadedFolderOfCcTexturesDropsInBesideThem) {
  const ScratchFolder scratch;
  // As they are unpacked: folders by asset, names with the resolution, and files that are no maps.
  for (const char* asset : {"Wood051", "Metal032", "Fabric030"}) {
    const fs::path folder = scratch.path() / "cctextures" / (std::string(asset) + "_2K-JPG");
    fs::create_directories(folder);
    for (const char* map : {"Color", "Displacement", "NormalDX", "NormalGL", "Roughness"}) {
      fs::copy_file(kHome / "materials/textures/Oak/Oak_Color.jpg",
                    folder / fmt::format("{}_2K-JPG_{}.jpg", asset, map));
    }
    ASSERT_TRUE(write_file(folder / (std::string(asset) + ".usdc"), "a model of the material"));
    ASSERT_TRUE(write_file(folder / (std::string(asset) + "_2K-JPG.mtlx"), "<materialx/>"));
  }
  auto config = read_campaign_config(
      "seedframe: 1\nmaterial_folders: [cctextures]\ncategories: [c]\nobjects: {o: {asset: cube, "
      "category: c, count: 2000, material: {realistic_share: 1}}}\ncamera: {distance_m: 9}\n",
      scratch.path() / "beside.yaml");
  ASSERT_TRUE(config) << config.error().message;
  auto library = MaterialLibrary::open({scratch.path() / "cctextures", kHome / "materials"},
                                       config->materials);
  ASSERT_TRUE(library) << library.error().message;
  EXPECT_EQ(surfaces_of(*library).size(), 105U);
  auto expander = SceneExpander::compile(*config, built_in_assets(), *library);
  ASSERT_TRUE(expander) << expander.error().message;
  std::set<std::string> drawn;
  for (const OfferedImage& image : expander->offered_images()) {
    drawn.insert(image.file.parent_path().filename().string());
  }
  EXPECT_EQ(drawn.size(), 105U);
  for (const char* name : {"Wood051_2K-JPG", "Metal032_2K-JPG", "Fabric030_2K-JPG", "Oak"}) {
    EXPECT_TRUE(drawn.contains(name)) << name;
  }
  const auto frame = expander->expand(0);
  ASSERT_TRUE(frame) << frame.error().message;
}

}  // namespace
}  // namespace seedframe
