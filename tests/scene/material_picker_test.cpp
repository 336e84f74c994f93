// Which material an object gets: by name, by slot, or as a share of the library.

#include "scene/material_picker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"
#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr int kMaterialScenes = 3000;

/// How often each material was taken in many scenes.
std::map<std::string, double> taken(const std::string& material) {
  std::map<std::string, double> counts;
  auto expander = expander_of("seedframe: 1\nseed: 9\nscenes: " + std::to_string(kMaterialScenes) +
                              "\nobjects: {o: {asset: cube, category: none, material: " + material +
                              "}}\ncamera: {distance_m: 1}\n");
  EXPECT_TRUE(expander) << expander.error().message;
  if (!expander) return counts;
  for (int scene = 0; scene < kMaterialScenes; ++scene) {
    const auto frame = expander->expand(scene, {.id = false, .draws = true});
    EXPECT_TRUE(frame) << frame.error().message;
    if (!frame) return counts;
    for (const Draw& draw : frame->draws) {
      if (draw.name == "objects.o.material/0") counts[draw.value.get<std::string>()] += 1.0;
    }
  }
  return counts;
}

TEST(MaterialShare, IsHowOftenARealisticMaterialIsTaken) {
  const auto counts = taken(
      "{realistic_share: 0.3, realistic: [Planks01, Fabric01], parametric: [steel, brass, zinc]}");
  ASSERT_EQ(counts.size(), 5u);
  EXPECT_GT(
      chi_squared_p({counts.at("Planks01"), counts.at("Fabric01"), counts.at("steel"),
                     counts.at("brass"), counts.at("zinc")},
                    {0.15 * kMaterialScenes, 0.15 * kMaterialScenes, 0.7 / 3 * kMaterialScenes,
                     0.7 / 3 * kMaterialScenes, 0.7 / 3 * kMaterialScenes}),
      kLeastP);
}

TEST(MaterialShare, ZeroAndOneLeaveNothingToTheOthers) {
  const std::string lists = ", realistic: [Planks01, Fabric01], parametric: [steel, brass]}";
  const auto none = taken("{realistic_share: 0" + lists);
  EXPECT_EQ(none.size(), 2u);
  EXPECT_EQ(none.at("steel") + none.at("brass"), kMaterialScenes);
  const auto all = taken("{realistic_share: 1" + lists);
  EXPECT_EQ(all.size(), 2u);
  EXPECT_EQ(all.at("Planks01") + all.at("Fabric01"), kMaterialScenes);
}

/// texture_repeat of the materials of a frame, in the order of its instances.
std::vector<double> repeats(const std::string& objects) {
  auto expander = expander_of(
      "seedframe: 1\nmaterials: {wood: {textures: Planks01, "
      "texture_size_m: 0.4}, plain: {textures: Planks01}}\n" +
      objects + "\ncamera: {distance_m: 1}\n");
  EXPECT_TRUE(expander) << expander.error().message;
  std::vector<double> found;
  if (!expander) return found;
  const auto frame = expander->expand(0);
  EXPECT_TRUE(frame) << frame.error().message;
  if (!frame) return found;
  for (const InstanceSpec& instance : frame->spec.instances) {
    const auto index = static_cast<std::size_t>(instance.materials[0]);
    found.push_back(frame->spec.materials[index].texture_repeat);
  }
  return found;
}

TEST(TextureSize, OnTheGroundAnImageIsAsWideAsItSays) {
  EXPECT_EQ(repeats("ground: {width_m: 2, depth_m: 2, material: wood}"),
            std::vector<double>{1.0 / 0.4});
  EXPECT_EQ(repeats("ground: {width_m: 2, depth_m: 2, material: plain}"), std::vector<double>{1.0});
}

TEST(TextureSize, OnAnObjectItGoesWithTheObjectsScale) {
  const auto found = repeats(
      "objects: {a: {asset: cube, category: none, material: wood}, b: {asset: cube, category: "
      "none, scale: 2, rotation_deg: [10, 20, 30], material: wood}, g: {scale: 4, material: wood, "
      "objects: {c: {asset: cube, category: none, scale: 0.5, material: parent}}}}");
  ASSERT_EQ(found.size(), 3U);
  const auto cube = AssetLibrary::open({SEEDFRAME_HOME "/assets"})->load("cube");
  EXPECT_EQ(found[0], (*cube)->metres_per_uv / 0.4);
  EXPECT_EQ(found[1], 2.0 * found[0]);
  EXPECT_EQ(found[2], 2.0 * found[0]) << "by its parent's scale, too";
}

TEST(TextureSize, IsInPlaceOfTheRepeatsAndAboveZero) {
  const auto message = [](const std::string& material) {
    const auto expander =
        expander_of("seedframe: 1\nmaterials: {wood: {textures: Planks01, " + material +
                    "}}\nobjects: {o: {asset: cube, category: none, material: wood}}\n"
                    "camera: {distance_m: 1}\n");
    if (!expander) return expander.error().message;
    const auto frame = expander->expand(0);
    return frame ? std::string() : frame.error().message;
  };
  EXPECT_THAT(message("texture_size_m: 1, texture_repeat: 2"), HasSubstr("in two ways"));
  EXPECT_THAT(message("texture_size_m: 0"), HasSubstr("texture_size_m must be above 0"));
  EXPECT_EQ(message("texture_size_m: {uniform: [0.1, 0.2]}"), "");
}

TEST(MaterialShare, AKindThatIsNeverTakenMayBeEmpty) {
  EXPECT_EQ(taken("{realistic_share: 0, realistic: []}").count("default"), 0u);
  EXPECT_EQ(taken("{realistic_share: 1, parametric: []}").count("steel"), 0u);
}

TEST(MaterialShare, WithoutListsItIsTheWholeLibrary) {
  const auto counts = taken("{realistic_share: 0.5}");
  const auto library = MaterialLibrary::open({kHome / "materials"}, {});
  // All of them but "default", which is for what has no material.
  EXPECT_EQ(counts.size(), library->materials().size() - 1);
  EXPECT_EQ(counts.count("default"), 0u);
  double realistic = 0.0;
  for (const auto& [name, count] : counts) {
    if (library->materials().at(name).textures) realistic += count;
  }
  EXPECT_GT(chi_squared_p({realistic, kMaterialScenes - realistic},
                          {0.5 * kMaterialScenes, 0.5 * kMaterialScenes}),
            kLeastP);
}

std::string object(const std::string& keys) {
  return "seedframe: 1\ncategories: [washer]\nobjects: {o: {asset: washer, " + keys +
         "}}\nmaterials: {red: {base_color: [1, 0, 0]}, blue: {base_color: [0, 0, 1]}}\ncamera: "
         "{distance_m: 1}\n";
}

TEST(MaterialShare, FaultsAreNamed) {
  EXPECT_THAT(scene_error(object("material: {realistic_share: 1.5}")),
              HasSubstr("realistic_share must be from 0 to 1, found 1.5"));
  EXPECT_THAT(scene_error(object("material: {realistic_share: 1, realistic: [Plonks01]}")),
              HasSubstr("there is no material 'Plonks01' (did you mean 'Planks01'?)"));
  EXPECT_THAT(scene_error(object("material: {realistic_share: 1, realistic: []}")),
              HasSubstr("there are no realistic materials to choose from"));
  EXPECT_THAT(scene_error(object("material: {realistic_share: 1, realistik: []}")),
              HasSubstr("unknown key (did you mean 'realistic'?)"));
}

TEST(Slots, HaveMaterialsOfTheirOwn) {
  const auto frame = first_frame(object("material: blue, slots: {body: red}"));
  const InstanceSpec& instance = frame.spec.instances.at(0);
  ASSERT_EQ(instance.materials.size(), 1u);
  EXPECT_EQ(frame.spec.materials.at(static_cast<std::size_t>(instance.materials[0])).base_color,
            (Rgb{1, 0, 0}));
  EXPECT_EQ(frame.spec.materials.size(), 1u);  // blue is not needed
}

TEST(Slots, TheOthersKeepTheObjectsMaterial) {
  const auto asset = built_in_assets().load("robot_standing");
  ASSERT_TRUE(asset);
  const std::vector<std::string>& names = (*asset)->mesh.slot_names;
  ASSERT_GT(names.size(), 2u);
  const auto frame = first_frame(
      "seedframe: 1\nobjects: {o: {asset: robot_standing, category: none, material: blue, slots: "
      "{" +
      names[1] +
      ": red}}}\nmaterials: {red: {base_color: [1, 0, 0]}, blue: {base_color: [0, 0, 1]}}\ncamera: "
      "{distance_m: 1}\n");
  const InstanceSpec& instance = frame.spec.instances.at(0);
  ASSERT_EQ(instance.materials.size(), names.size());
  for (std::size_t slot = 0; slot < names.size(); ++slot) {
    const auto& material =
        frame.spec.materials.at(static_cast<std::size_t>(instance.materials[slot]));
    EXPECT_EQ(material.base_color, slot == 1 ? (Rgb{1, 0, 0}) : (Rgb{0, 0, 1})) << names[slot];
  }
}

TEST(Slots, DrawUnderTheirOwnKeys) {
  const auto frame = first_frame(object("slots: {body: {choice: [red, blue]}}"));
  EXPECT_TRUE(draws_by_name(frame).contains("objects.o.slots.body/0"));
}

TEST(Slots, FaultsAreNamed) {
  EXPECT_THAT(scene_error(object("slots: {boddy: red}")),
              HasSubstr("no asset of 'o' has a material slot 'boddy' (did you mean 'body'?)"));
  EXPECT_THAT(scene_error(object("slots: {body: rde}")),
              HasSubstr("objects.o.slots.body: there is no material 'rde' (did you mean 'red'?)"));
  EXPECT_THAT(scene_error(object("slots: [body]")),
              HasSubstr("objects.o.slots: expected a mapping of material slots"));
}

TEST(Materials, AColourBeyondAllNumbersIsRefused) {
  EXPECT_THAT(
      scene_error("seedframe: 1\nground: {material: m}\nmaterials: {m: {base_color: {hsv: [0, "
                  "0, 1e300]}}}\ncamera: {distance_m: 1}\n"),
      HasSubstr("scene.yaml: the colour of a material has a number that is too large"));
}

TEST(Materials, AlikeOnesAreListedOnce) {
  const auto frame = first_frame(
      "seedframe: 1\nobjects: {o: {asset: cube, category: none, count: 5, material: red}}\n"
      "materials: {red: {base_color: [1, 0, 0]}}\ncamera: {distance_m: 1}\n");
  EXPECT_EQ(frame.spec.materials.size(), 1u);
  EXPECT_EQ(frame.spec.instances.size(), 5u);
}

}  // namespace
}  // namespace seedframe
