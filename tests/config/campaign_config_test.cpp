#include "config/campaign_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSmallest = R"(seedframe: 1
camera: {distance_m: 1}
)";

std::string error_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  const auto config = read_campaign_config(text, "scene.yaml", overrides);
  return message_of(config);
}

TEST(CampaignConfig, TheSmallestConfigHasDefaults) {
  const auto config = read_campaign_config(kSmallest, "tiny.yaml");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->name, "tiny");
  EXPECT_EQ(config->frame_count(), 1);
  EXPECT_EQ(config->render.width, 640);
  EXPECT_EQ(config->image.settings.view, "Filmic");
  EXPECT_FALSE(config->ground.has_value());
}

TEST(CampaignConfig, ReadsEveryDistribution) {
  const auto config = read_campaign_config(std::string(kSmallest) + R"(
variables:
  scene:
    a: 3
    b: {constant: 4}
    c: {uniform: [0, 1]}
    d: {normal: {mean: 0, std: 1}}
    e: {truncated_normal: [0, 1, -1, 1]}
    f: {log_uniform: [1, 10]}
    g: {integer: [1, 6]}
    h: {choice: [1, 2, 3]}
    i: {choice: {1.5: 2, 2.5: 1}}
    j: {choice: [{value: 1, weight: 3}, {value: "a + 1"}]}
    k: {choice: {red: 1, blue: 2}}
    l: a * 2
    m: {bounded_normal: [0, 0.5, -1, 1]}
)",
                                           "t.yaml");
  ASSERT_TRUE(config) << config.error().message;
  ASSERT_EQ(config->scene_variables.size(), 13u);
  EXPECT_TRUE(std::holds_alternative<NameSource>(config->scene_variables[10].source));
  const auto& weighted = std::get<NumberSource>(config->scene_variables[9].source);
  EXPECT_EQ(std::get<std::shared_ptr<const Distribution>>(weighted.value)->parameters.size(), 2u);
}

TEST(CampaignConfig, ErrorsCarryFileLineColumnAndKey) {
  EXPECT_THAT(error_of("seedframe: 1\ncamera: {distance_m: 1}\nrender:\n  width: 0\n"),
              HasSubstr("scene.yaml:4:10: render.width: expected a whole number from 1 to 16384, "
                        "found '0'"));
}

TEST(CampaignConfig, UnknownKeysAreErrorsWithASuggestion) {
  EXPECT_THAT(error_of("seedframe: 1\ncamera: {distance_m: 1}\nrender: {sampels: 4}\n"),
              HasSubstr("scene.yaml:3:19: render.sampels: unknown key (did you mean 'samples'?)"));
  EXPECT_THAT(error_of(std::string(kSmallest) + "objekts: {}\n"),
              HasSubstr("did you mean 'objects'?"));
}

TEST(CampaignConfig, OneRunNamesEveryMistake) {
  const std::string error = error_of(
      "seedframe: 1\ncamera: {distance_m: 1}\nscenes: -1\nrender: {width: a, heigth: 2}\n");
  EXPECT_THAT(error, HasSubstr("scenes: expected a whole number"));
  EXPECT_THAT(error, HasSubstr("render.width: expected a whole number"));
  EXPECT_THAT(error, HasSubstr("did you mean 'height'?"));
}

TEST(CampaignConfig, RefusesWhatIsNoScene) {
  struct Case {
    const char* text;
    const char* expected;
  };
  const std::vector<Case> cases = {
      {"camera: {distance_m: 1}", "the key 'seedframe' is missing"},
      {"seedframe: 99\ncamera: {distance_m: 1}", "this program reads version 1"},
      {"seedframe: 1", "the key 'camera' is missing"},
      {"seedframe: 1\ncamera: {}", "a camera needs a position, or a distance_m"},
      {"seedframe: 1\ncamera: {distance_m: 1, position: [0, 0, 1]}", "exclude each other"},
      {"seedframe: 1\ncamera: {distance_m: .nan}", "a number must be finite"},
      {"seedframe: 1\ncamera: {distance_m: 1e999}", "must be finite, found '1e999'"},
      {"seedframe: 1\ncamera: {distance_m: {unifrom: [0, 1]}}",
       "unknown distribution 'unifrom' (did you mean 'uniform'?)"},
      {"seedframe: 1\ncamera: {distance_m: {uniform: [0]}}", "uniform needs [min, max]"},
      {"seedframe: 1\ncamera: {distance_m: {normal: {mean: 0}}}", "normal needs 'std'"},
      {"seedframe: 1\ncamera: {distance_m: [1, 2]}", "expected a number, a formula"},
      {"seedframe: 1\ncamera: {distance_m: 1, target: [0, 0]}", "three numbers [x, y, z]"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nrender: {passes: [dept]}",
       "unknown pass 'dept' (did you mean 'depth'?)"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nlights: {l: {type: pint, power: 1}}",
       "unknown type of light (did you mean 'point'?)"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nlights: {l: {}}",
       "the key 'power' or 'lumens' is missing"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nobjects: {o: {}}", "the key 'asset' is missing"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nobjects: {1x: {asset: cube}}", "a name must be"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nobjects: [a]", "expected a mapping"},
      {"seedframe: 1\ncamera: {distance_m: 1}\ncategories: [a, a]", "is listed twice"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nscenes: 99999999\nframes_per_scene: 9999",
       "must not exceed"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nasset_folders: [nowhere]", "there is no folder"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nimage: {ocio_config: nowhere}",
       "path of an OpenColorIO config"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nname: ../../etc", "a campaign's name is letters"},
      {"seedframe: 1\ncamera: {distance_m: 1}\nworld: {color: {kelvin: 5000, rgb: [1, 1, 1]}}",
       "one of hsv, kelvin and rgb"},
      {"seedframe: 1\nseed: 1\nseed: 2\ncamera: {distance_m: 1}", "is given twice"},
      {"seedframe: 1\n  bad indent: [", "this is not YAML"},
      {"", "the key 'seedframe' is missing"},
      {"[1, 2]", "expected a mapping"},
  };
  for (const Case& c : cases) {
    EXPECT_THAT(error_of(c.text), HasSubstr(c.expected)) << c.text;
  }
}

TEST(CampaignConfig, AnAliasBombIsRefusedQuickly) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int j = 0; j < 10; ++j) bomb += (j > 0 ? ", *a" : "*a") + std::to_string(i - 1);
    bomb += "]\n";
  }
  EXPECT_THAT(error_of(bomb), HasSubstr("more than 250000 values"));
}

TEST(CampaignConfig, TheSourceOfLabelsMayStandAlone) {
  const auto labels_of = [](const std::string& text) {
    return read_campaign_config(kSmallest, "t.yaml", {{"labels", text}})->labels;
  };
  EXPECT_EQ(read_campaign_config(kSmallest, "t.yaml")->labels.source, LabelSource::kIndexPass);
  EXPECT_TRUE(read_campaign_config(kSmallest, "t.yaml")->labels.check.wanted);
  EXPECT_EQ(labels_of("geometry").source, LabelSource::kTwin);
  EXPECT_EQ(labels_of("render").source, LabelSource::kIndexPass);
  const LabelConfig all =
      labels_of("{source: geometry, check: false, tolerance: 0.5, edge_tolerance: 1}");
  EXPECT_EQ(all.source, LabelSource::kTwin);
  EXPECT_FALSE(all.check.wanted);
  EXPECT_DOUBLE_EQ(all.check.tolerance.inside_share, 0.5);
  EXPECT_DOUBLE_EQ(all.check.tolerance.outline_share, 1.0);
}

TEST(Overrides, ReplaceAndAddValues) {
  const auto config = read_campaign_config(
      kSmallest, "t.yaml",
      {{"render.samples", "7"}, {"variables.scene.n", "{uniform: [0, 1]}"}, {"seed", "12"}});
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->render.samples, 7);
  EXPECT_EQ(config->seed, 12u);
  ASSERT_EQ(config->scene_variables.size(), 1u);
}

TEST(Overrides, ErrorsPointAtTheCommandLine) {
  EXPECT_THAT(error_of(kSmallest, {{"render.samples", "many"}}),
              HasSubstr("--set render.samples=many: render.samples: expected a whole number"));
  EXPECT_THAT(error_of(kSmallest, {{"seedframe.x", "1"}}), HasSubstr("it is not a mapping"));
  EXPECT_FALSE(parse_override("no-equals-sign"));
  EXPECT_EQ(parse_override("a.b=c=d")->value, "c=d");
}

TEST(MaterialLibraryFile, HasMaterialsAndNothingElse) {
  const auto good = read_material_library("materials: {a: {roughness: 0.2}}", "library.yaml");
  ASSERT_TRUE(good);
  EXPECT_EQ(good->front().name, "a");
  EXPECT_FALSE(read_material_library("objects: {}", "library.yaml"));
}

}  // namespace
}  // namespace seedframe
