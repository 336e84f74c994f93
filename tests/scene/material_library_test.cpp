#include "scene/material_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "scene/offered_images.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

class MaterialFolder : public ::testing::Test {
 protected:
  void add(const std::string& file) {
    const fs::path path = folder_ / file;
    fs::create_directories(path.parent_path());
    ASSERT_TRUE(write_file(path, "not looked at here"));
  }

  MaterialLibrary library() const { return *MaterialLibrary::open({folder_.path()}, {}); }

  /// Role to file name.
  std::map<std::string, std::string> files_of(const std::string& set) const {
    std::map<std::string, std::string> files;
    const MaterialLibrary all = library();
    const auto found = all.texture_sets().find(set);
    if (found == all.texture_sets().end()) return files;
    for (const auto& [role, file] : found->second.files) files[role] = file.filename().string();
    return files;
  }

  /// Name of each image that a config offers, and its use.
  std::vector<std::pair<std::string, ImageUse>> offered(const std::string& config) const {
    std::vector<std::pair<std::string, ImageUse>> result;
    auto read = read_campaign_config("seedframe: 1\ncamera: {distance_m: 1}\n" + config, "s.yaml");
    EXPECT_TRUE(read) << read.error().message;
    auto expander = SceneExpander::compile(
        *read, built_in_assets(), *MaterialLibrary::open({folder_.path()}, read->materials));
    EXPECT_TRUE(expander) << expander.error().message;
    if (!expander) return result;
    for (const OfferedImage& image : expander->offered_images()) {
      result.emplace_back(image.file.filename().string(), image.use);
    }
    return result;
  }

  ScratchFolder folder_;
};

TEST_F(MaterialFolder, AmbientCgSetsAreUnderstood) {
  for (const char* map : {"Color", "Roughness", "NormalGL", "NormalDX", "Metalness", "Opacity",
                          "AmbientOcclusion", "Displacement"}) {
    add(std::string("Grid001_2K-PNG/Grid001_2K-PNG_") + map + ".png");
  }
  add("Grid001_2K-PNG/Grid001.png");
  EXPECT_THAT(files_of("Grid001_2K-PNG"),
              UnorderedElementsAre(Pair("color", "Grid001_2K-PNG_Color.png"),
                                   Pair("roughness", "Grid001_2K-PNG_Roughness.png"),
                                   Pair("normal", "Grid001_2K-PNG_NormalGL.png"),
                                   Pair("metallic", "Grid001_2K-PNG_Metalness.png"),
                                   Pair("alpha", "Grid001_2K-PNG_Opacity.png")));
}

TEST_F(MaterialFolder, PolyHavenSetsAreUnderstoodWithAndWithoutTheirResolution) {
  for (const char* file : {"rust_diff_2k.jpg", "rust_nor_gl_2k.exr", "rust_nor_dx_2k.exr",
                           "rust_rough_2k.exr", "rust_metal_16K.png", "rust_ao_2k.jpg",
                           "rust_arm_2k.jpg", "rust_disp_2k.png", "rust_alpha_2k.png"}) {
    add(std::string("rust_2k/") + file);
  }
  EXPECT_THAT(files_of("rust_2k"), UnorderedElementsAre(Pair("color", "rust_diff_2k.jpg"),
                                                        Pair("normal", "rust_nor_gl_2k.exr"),
                                                        Pair("roughness", "rust_rough_2k.exr"),
                                                        Pair("metallic", "rust_metal_16K.png"),
                                                        Pair("alpha", "rust_alpha_2k.png")));
  add("leaf/leaf_diff.webp");
  add("leaf/leaf_opacity.tga");
  EXPECT_THAT(files_of("leaf"), UnorderedElementsAre(Pair("color", "leaf_diff.webp"),
                                                     Pair("alpha", "leaf_opacity.tga")));
}

TEST_F(MaterialFolder, ANormalMapForDirectXIsNotTakenForOne) {
  add("A/A_Color.png");
  add("A/A_NormalDX.png");
  add("B/B_diff_1k.png");
  add("B/B_nor_dx_1k.png");
  EXPECT_EQ(files_of("A").count("normal"), 0u);
  EXPECT_EQ(files_of("B").count("normal"), 0u);
}

TEST_F(MaterialFolder, EveryKindThatIsReadMakesASet) {
  for (const char* ending :
       {"png", "jpg", "JPEG", "tif", "TIFF", "exr", "hdr", "webp", "tga", "bmp"}) {
    add(std::string(ending) + "/x_Color." + ending);
    EXPECT_EQ(files_of(ending).count("color"), 1u) << ending;
  }
}

TEST_F(MaterialFolder, PngAndJpegComeBeforeOtherKindsOfTheSameRole) {
  for (const char* ending : {"bmp", "exr", "jpg", "png", "tif"}) {
    add(std::string("x/x_Color.") + ending);
  }
  EXPECT_EQ(files_of("x")["color"], "x_Color.jpg");
}

TEST_F(MaterialFolder, ASetWhoseOnlyFaultIsItsEndingSaysSo) {
  add("psd/psd_Color.psd");
  add("psd/psd_Roughness.png");
  add("hdri/sky.png");
  const MaterialLibrary all = library();
  const std::string file = (folder_ / "psd/psd_Color.psd").string();
  EXPECT_EQ(all.no_material("psd"), "there is no texture set 'psd': its colour is " + file +
                                        ", and images end in .png, .jpg, .jpeg, .tif, .tiff, "
                                        ".exr, .hdr, .webp, .tga, .bmp");
  EXPECT_EQ(all.no_texture_set("psd"), all.no_material("psd"));
  EXPECT_EQ(all.no_hdri("sky"),
            "there is no environment map 'sky': environment maps end in .exr or .hdr, not as " +
                (folder_ / "hdri/sky.png").string());
  EXPECT_THAT(all.no_material("pds"), HasSubstr("there is no material 'pds'"));
  EXPECT_THAT(all.no_hdri("skies"), HasSubstr("there is no environment map 'skies'"));
}

TEST_F(MaterialFolder, DecalsAreForTheTexturesOfMaterialsAndNoMaterials) {
  add("textures/Wood/Wood_Color.png");
  add("decals/Logo/Logo_Color.png");
  const MaterialLibrary all = library();
  EXPECT_THAT(all.texture_set_names(), ElementsAre("Logo", "Wood"));
  EXPECT_THAT(all.material_names(), ElementsAre("Wood", "default"));
  EXPECT_EQ(all.no_material("Logo"),
            "'Logo' is a decal, no material: name it in the `textures` of one");
  const std::string cube = "categories: [c]\nobjects: {o: {asset: cube, category: c, material: ";
  EXPECT_THAT(offered(cube + "{realistic_share: 1}}}\n"),
              ElementsAre(Pair("Wood_Color.png", ImageUse::kColor)));
  EXPECT_THAT(offered(cube + "sign}}\nmaterials: {sign: {textures: Logo}}\n"),
              ElementsAre(Pair("Logo_Color.png", ImageUse::kColor)));
}

TEST_F(MaterialFolder, OnlyImagesThatCanBeDrawnAreOffered) {
  for (const char* set : {"A", "B", "C"}) {
    add(std::string(set) + "/" + set + "_Color.png");
    add(std::string(set) + "/" + set + "_Roughness.png");
  }
  for (const char* map : {"day", "night"}) add(std::string("hdri/") + map + ".exr");
  EXPECT_TRUE(offered("").empty());
  EXPECT_THAT(
      offered("ground: {material: B}\n"),
      ElementsAre(Pair("B_Color.png", ImageUse::kColor), Pair("B_Roughness.png", ImageUse::kData)));
  EXPECT_THAT(offered("world: {hdri: night}\n"),
              ElementsAre(Pair("night.exr", ImageUse::kEnvironment)));
  EXPECT_EQ(offered("world: {hdri: {choice: [day, night]}}\n").size(), 2u);
  EXPECT_EQ(offered("categories: [c]\nobjects: {o: {asset: cube, category: c, material: {choice: "
                    "[A, default, C]}}}\n")
                .size(),
            4u);
}

TEST_F(MaterialFolder, WhereOnlyADrawTellsTheNameEveryImageIsOfferedOnce) {
  for (const char* set : {"A", "B"}) add(std::string(set) + "/" + set + "_Color.png");
  const std::string cube = "{asset: cube, category: c, material: ";
  EXPECT_EQ(
      offered("variables: {scene: {m: {choice: [A, B]}}}\nground: {material: \"${m}\"}\n").size(),
      2u);
  EXPECT_EQ(offered("categories: [c]\nground: {material: A}\nobjects:\n  o: " + cube +
                    "{realistic_share: 0.5}}\n  group:\n    objects: {i: " + cube + "B}}\n")
                .size(),
            2u);
  EXPECT_THAT(offered("materials: {m: {textures: B}}\nground: {material: m}\n"),
              ElementsAre(Pair("B_Color.png", ImageUse::kColor)));
}

}  // namespace
}  // namespace seedframe
