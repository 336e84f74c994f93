// material: own, what an asset's file gave its slots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assets/asset_import.h"
#include "base/files.h"
#include "base/sha256.h"
#include "image/png_file.h"
#include "scene/offered_images.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

/// An asset 'part' with the slots steel, which is red, wood, which has an image, and bare; and an
/// asset 'plain' without materials.
class OwnMaterial : public ::testing::Test {
 protected:
  void SetUp() override {
    Image<std::uint8_t> image(2, 2, 3);
    image.values.assign(12, 77);
    wood_ = encode_png(image);
    ASSERT_TRUE(write_file(folder_ / "wood.png", wood_));
    ASSERT_TRUE(write_file(folder_ / "part.mtl",
                           "newmtl steel\nKd 1 0 0\nPr 0.25\nnewmtl wood\nmap_Kd wood.png\n"));
    const std::string text =
        "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nusemtl steel\nf 1 3 2\nusemtl wood\nf 1 2 4\n"
        "usemtl bare\nf 1 4 3\nf 2 3 4\n";
    import("part", "mtllib part.mtl\n" + text);
    import("plain", text);
  }

  void import(const std::string& name, const std::string& text) const {
    ASSERT_TRUE(write_file(folder_ / "file.obj", text));
    AssetImport request;
    request.file = folder_ / "file.obj";
    request.root = folder_ / "lib";
    request.name = name;
    request.category = name;
    request.scale = 0.1;
    const auto imported = import_asset(request);
    ASSERT_TRUE(imported) << imported.error().message;
  }

  Result<SceneExpander> expander(const std::string& objects) const {
    const auto config = read_campaign_config(
        "seedframe: 1\ncamera: {distance_m: 1}\ncategories: [part, plain]\n" + objects, "t.yaml");
    if (!config) return forward_error(config);
    return SceneExpander::compile(
        *config, *AssetLibrary::open({folder_ / "lib"}),
        *MaterialLibrary::open({}, config->materials, AllowedFolders({folder_.path()})));
  }

  /// Of the first instance's slots, in the first frame.
  std::vector<MaterialSpec> slots_of(const std::string& objects) const {
    std::vector<MaterialSpec> slots;
    const auto scene = expander(objects);
    EXPECT_TRUE(scene) << scene.error().message;
    if (!scene) return slots;
    const auto frame = scene->expand(0);
    EXPECT_TRUE(frame) << frame.error().message;
    if (!frame) return slots;
    for (const int index : frame->spec.instances.front().materials) {
      slots.push_back(frame->spec.materials[static_cast<std::size_t>(index)]);
    }
    return slots;
  }

  ScratchFolder folder_;
  std::string wood_;
};

TEST_F(OwnMaterial, GivesEachSlotWhatItsFileHad) {
  const auto slots = slots_of("objects: {o: {asset: part, material: own}}\n");
  ASSERT_EQ(slots.size(), 3u);
  EXPECT_THAT(slots[0].base_color, ElementsAre(1.0, 0.0, 0.0));
  EXPECT_EQ(slots[0].roughness, 0.25);
  EXPECT_THAT(slots[1].textures, ElementsAre(Pair("color", sha256_hex(wood_))));
  EXPECT_THAT(slots[2].base_color, ElementsAre(0.8, 0.8, 0.8)) << "it has none";
}

TEST_F(OwnMaterial, StandsBesideOthers) {
  const std::string blue = "materials: {blue: {base_color: [0, 0, 1]}}\n";
  auto slots =
      slots_of(blue + "objects: {o: {asset: part, material: blue, slots: {steel: own}}}\n");
  EXPECT_THAT(slots[0].base_color, ElementsAre(1.0, 0.0, 0.0));
  EXPECT_THAT(slots[1].base_color, ElementsAre(0.0, 0.0, 1.0));
  slots = slots_of(blue + "objects: {o: {asset: part, material: own, slots: {steel: blue}}}\n");
  EXPECT_THAT(slots[0].base_color, ElementsAre(0.0, 0.0, 1.0));
  EXPECT_EQ(slots[1].textures.size(), 1u);
  slots = slots_of(blue + "objects: {o: {asset: part, material: {choice: {own: 1, blue: 0}}}}\n");
  EXPECT_EQ(slots[1].textures.size(), 1u);
  slots = slots_of(
      "materials: {own: {base_color: [0, 1, 0]}}\nobjects: {o: {asset: part, material: "
      "own}}\n");
  EXPECT_THAT(slots[0].base_color, ElementsAre(0.0, 1.0, 0.0)) << "the config's own 'own'";
}

TEST_F(OwnMaterial, OffersItsImagesAndDependsOnThem) {
  const auto scene = expander("objects: {o: {asset: part, material: own}}\n");
  ASSERT_TRUE(scene);
  const auto offered = scene->offered_images();
  ASSERT_EQ(offered.size(), 1u);
  EXPECT_EQ(offered[0].use, ImageUse::kColor);
  EXPECT_EQ(scene->expand(0)->used.images.count(sha256_hex(wood_)), 1u);
  EXPECT_THAT(expander("objects: {o: {asset: part}}\n")->offered_images(), IsEmpty());
  ASSERT_TRUE(write_file(offered[0].file, "damaged"));
  const auto frame = expander("objects: {o: {asset: part, material: own}}\n")->expand(0);
  EXPECT_THAT(message_of(frame), HasSubstr("is damaged"));
}

TEST_F(OwnMaterial, IsRefusedWhereThereIsNone) {
  const auto message = [&](const std::string& text) {
    const auto scene = expander(text);
    if (!scene) return scene.error().message;
    const auto frame = scene->expand(0);
    return message_of(frame);
  };
  EXPECT_THAT(message("objects: {o: {asset: plain, material: own}}\n"),
              HasSubstr("the asset 'plain' has no materials of its own"));
  EXPECT_THAT(message("objects: {o: {asset: plain, slots: {steel: own}}}\n"),
              HasSubstr("the asset 'plain' has no materials of its own"));
  EXPECT_THAT(message("ground: {material: own}\n"), HasSubstr("there is no material 'own'"));
}

}  // namespace
}  // namespace seedframe
