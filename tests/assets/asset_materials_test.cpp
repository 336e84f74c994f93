#include "assets/asset_materials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assets/asset_check.h"
#include "assets/asset_import.h"
#include "assets/asset_library.h"
#include "base/files.h"
#include "base/sha256.h"
#include "image/png_file.h"
#include "image_files/image_reader.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// 2 × 1 pixels.
std::shared_ptr<const FileImage> rgb_image(const std::vector<std::uint8_t>& values) {
  Image<std::uint8_t> image(2, 1, 3);
  image.values = values;
  return std::make_shared<const FileImage>(FileImage{"test.png", encode_png(image)});
}

MadeMaterials made_of(const FileMaterial& material) {
  return make_materials({{"steel", material}}, {"steel", "bare"});
}

std::vector<std::uint8_t> pixels(const MadeMaterials& made, const std::string& role) {
  const std::string& bytes = made.files.at(made.materials.at("steel").files.at(role));
  return decode_image8(bytes, ImageKind::kPng, role)->values;
}

TEST(AssetMaterials, ImagesAreKeptAndChannelsTakenApart) {
  FileMaterial material;
  const auto image = rgb_image({10, 100, 200, 20, 50, 0});
  material.textures["color"].image = image;
  material.textures["roughness"] = {.image = image, .channel = 1, .factor = 0.5};
  material.textures["metallic"] = {.image = image, .channel = 2};
  const MadeMaterials made = made_of(material);
  EXPECT_THAT(made.dropped, IsEmpty());
  EXPECT_THAT(made.materials, SizeIs(1));
  const AssetMaterial& steel = made.materials.at("steel");
  EXPECT_EQ(made.files.at(steel.files.at("color")), image->bytes) << "bit for bit";
  EXPECT_EQ(steel.spec.textures.at("color"), sha256_hex(image->bytes));
  EXPECT_THAT(pixels(made, "roughness"), ElementsAre(50, 25));
  EXPECT_THAT(pixels(made, "metallic"), ElementsAre(200, 0));
}

TEST(AssetMaterials, WhatIsTheSameEverywhereIsANumber) {
  FileMaterial material;
  material.textures["roughness"] = {.image = rgb_image({0, 51, 0, 9, 51, 9}), .channel = 1};
  material.textures["alpha"] = {.image = rgb_image({0, 51, 0, 9, 51, 9}), .channel = 3};
  const MadeMaterials made = made_of(material);
  EXPECT_THAT(made.files, IsEmpty()) << "no image of opacity either: it has no holes";
  EXPECT_DOUBLE_EQ(made.materials.at("steel").spec.roughness, 0.2);
}

TEST(AssetMaterials, OpacityIsAnImage) {
  FileMaterial material;
  material.textures["alpha"].factor = 0.4;
  EXPECT_THAT(pixels(made_of(material), "alpha"), ElementsAre(102));
  material.textures["alpha"] = {
      .image = rgb_image({0, 0, 0, 0, 0, 0}), .channel = 3, .factor = 0.4};
  EXPECT_THAT(pixels(made_of(material), "alpha"), ElementsAre(102, 102));
  material.textures["alpha"].cutoff = 0.5;
  EXPECT_THAT(pixels(made_of(material), "alpha"), ElementsAre(0, 0));
  material.textures["alpha"].cutoff = 0.3;
  EXPECT_THAT(made_of(material).files, IsEmpty());
}

TEST(AssetMaterials, ImagesThatBlenderCouldNotRenderAreDropped) {
  FileMaterial material;
  for (const std::string bytes : {"", "<html>", "\x89PNG\r\n\x1a\n cut"}) {
    material.textures["color"].image =
        std::make_shared<const FileImage>(FileImage{"wood.png", bytes});
    const MadeMaterials made = made_of(material);
    EXPECT_THAT(made.dropped, ElementsAre(HasSubstr("an image of the material 'steel' is left out: "
                                                    "wood.png")));
    EXPECT_THAT(made.materials.at("steel").files, IsEmpty());
  }
}

class OwnMaterials : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_file(folder_ / "wood.png", rgb_image({1, 2, 3, 4, 5, 6})->bytes));
    ASSERT_TRUE(write_file(folder_ / "part.mtl", "newmtl steel\nmap_Kd wood.png\nPr 0.25\n"));
    ASSERT_TRUE(write_file(folder_ / "part.obj",
                           "mtllib part.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nusemtl steel\n"
                           "f 1 3 2\nf 1 2 4\nusemtl bare\nf 1 4 3\nf 2 3 4\n"));
    AssetImport request;
    request.file = folder_ / "part.obj";
    request.root = folder_ / "lib";
    request.name = "part";
    request.scale = 0.1;
    const auto report = import_asset(request);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_THAT(report->warnings, IsEmpty());
  }

  fs::path part() const { return folder_ / "lib/part"; }

  ScratchFolder folder_;
};

TEST_F(OwnMaterials, StayWithTheAsset) {
  const auto asset = AssetLibrary::open({folder_ / "lib"})->load("part");
  ASSERT_TRUE(asset) << asset.error().message;
  ASSERT_THAT((*asset)->materials, SizeIs(1));
  const AssetMaterial& steel = (*asset)->materials.at("steel");
  EXPECT_EQ(steel.spec.roughness, 0.25);
  EXPECT_THAT(steel.spec.base_color, ElementsAre(1.0, 1.0, 1.0));
  const auto bytes = read_file(steel.files.at("color"));
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(sha256_hex(*bytes), steel.spec.textures.at("color"));
  EXPECT_TRUE(check_asset(part(), {}).empty());
}

TEST_F(OwnMaterials, DamageIsFound) {
  const Json json = *parse_json(*read_file(part() / "asset.json"), "asset.json");
  const std::string file = json["materials"]["steel"]["textures"]["color"]["file"];
  ASSERT_TRUE(write_file(part() / file, "damaged"));
  EXPECT_THAT(check_asset(part(), {}), ElementsAre(HasSubstr(file + " is damaged")));
  for (const auto& [place, value] : std::vector<std::pair<std::string, Json>>{
           {"/materials/steel/roughness", 2.0},
           {"/materials/steel/base_color", Json::array({1, 2})},
           {"/materials/steel/textures/color/file", "../secret.png"},
           {"/materials/steel/textures/color/file", "textures/.hidden.png"},
           {"/materials/steel/textures/height", Json::object()},
           {"/materials", 3}}) {
    Json wrong = json;
    wrong[Json::json_pointer(place)] = value;
    ASSERT_TRUE(write_file(part() / "asset.json", readable_json(wrong)));
    const auto asset = AssetLibrary::open({folder_ / "lib"})->load("part");
    ASSERT_FALSE(asset) << place;
    EXPECT_EQ(asset.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(asset.error().message, HasSubstr("asset.json: materials"));
  }
}

}  // namespace
}  // namespace seedframe
