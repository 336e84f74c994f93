// A config that is another one with some values replaced.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "config/campaign_config.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class BaseConfig : public ::testing::Test {
 protected:
  void SetUp() override {
    write("base.yaml",
          "seedframe: 1\nname: base\nseed: 3\nscenes: 4\nrender: {width: 64}\ncamera: {distance_m: "
          "1}\n");
  }
  void write(const std::string& name, const std::string& text) {
    EXPECT_TRUE(write_file(folder_ / name, text));
  }
  Result<CampaignConfig> read(const std::string& text,
                              const std::vector<Override>& overrides = {}) {
    return read_campaign_config(text, folder_ / "top.yaml", overrides);
  }
  std::string error_of(const std::string& text) {
    const auto config = read(text);
    return message_of(config);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  ScratchFolder folder_;
};

TEST_F(BaseConfig, IsTakenAsItIs) {
  const auto config = read("base: base.yaml\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->seed, 3u);
  EXPECT_EQ(config->scenes, 4);
  EXPECT_EQ(config->render.width, 64);
}

TEST_F(BaseConfig, ValuesAreReplacedAndAdded) {
  const auto config = read(
      "base: base.yaml\nname: other\nset:\n  seed: 8\n  render.samples: 5\n"
      "  variables.scene.n: {uniform: [0, 1]}\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->name, "other");
  EXPECT_EQ(config->seed, 8u);
  EXPECT_EQ(config->render.width, 64);
  EXPECT_EQ(config->render.samples, 5);
  EXPECT_EQ(config->scene_variables.size(), 1u);
}

TEST_F(BaseConfig, TheCommandLineComesLast) {
  const auto config = read("base: base.yaml\nset: {seed: 8}\n", {{"seed", "9"}});
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->seed, 9u);
}

TEST_F(BaseConfig, MayHaveABaseItself) {
  write("middle.yaml", "base: base.yaml\nset: {seed: 8, scenes: 7}\n");
  const auto config = read("base: middle.yaml\nset: {seed: 9}\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->seed, 9u);
  EXPECT_EQ(config->scenes, 7);
}

TEST_F(BaseConfig, GraphsFromOutsideAreOneLineAFrameInPlaceOfScenesAndSweep) {
  write("graphs.jsonl", "{}\n");
  write("swept.yaml",
        "base: base.yaml\nset:\n  frames_per_scene: 5\n  variables.campaign: {reach: 2}\n  sweep: "
        "{values: {tint: [{low: 1, high: 2}, {low: 3, high: 4}], kind: [gear, nut], n: [7, 8]}}\n");
  const Override graphs{"graphs", "graphs.jsonl"};
  const Override frames{"frames_per_scene", "3"};
  const auto config = read("base: swept.yaml\n", {graphs});
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->sweep.size(), 1);
  EXPECT_EQ(config->frames_per_scene, 1);
  std::vector<std::string> names;
  for (const VariableConfig& variable : config->campaign_variables) names.push_back(variable.name);
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("reach", "low", "high", "kind", "n"));
  for (const VariableConfig& variable : config->campaign_variables) {
    EXPECT_EQ(std::holds_alternative<NameSource>(variable.source), variable.name == "kind");
  }
  for (const auto& changes : {std::vector{graphs, frames}, std::vector{frames, graphs}}) {
    const auto several = read("base: swept.yaml\n", changes);
    ASSERT_TRUE(several) << several.error().message;
    EXPECT_EQ(several->frames_per_scene, 3);
  }
  const auto inside = read("base: swept.yaml\nset: {frames_per_scene: 2, graphs: graphs.jsonl}\n");
  ASSERT_TRUE(inside) << inside.error().message;
  EXPECT_EQ(inside->frames_per_scene, 2);
}

TEST_F(BaseConfig, StreamsOfASeedHaveOtherDraws) {
  const auto config = read("base: base.yaml\n");
  const auto initial = read("base: base.yaml\nset: {stream: initial}\n");
  const auto target = read("base: base.yaml\nset: {stream: target}\n");
  ASSERT_TRUE(config && initial && target);
  EXPECT_EQ(config->draw_seed(), 3u) << "as it has always been";
  EXPECT_EQ(initial->seed, 3u);
  EXPECT_NE(initial->draw_seed(), 3u);
  EXPECT_NE(initial->draw_seed(), target->draw_seed());
  EXPECT_THAT(error_of("base: base.yaml\nset: {stream: \"two\\nlines\"}\n"),
              HasSubstr("the name of a stream is one line"));
}

TEST_F(BaseConfig, MistakesPointToTheFileInWhichTheyStand) {
  EXPECT_THAT(error_of("base: base.yaml\nset:\n  render.width: 0\n"),
              HasSubstr(path("top.yaml") + ":3:17: render.width: expected a whole number"));
  write("base.yaml", "seedframe: 1\ncamera: {distance: 1}\n");
  EXPECT_THAT(error_of("base: base.yaml\n"),
              HasSubstr(path("base.yaml") + ":2:20: camera.distance: unknown key"));
}

TEST_F(BaseConfig, HasNothingElseBesideIt) {
  EXPECT_THAT(error_of("base: base.yaml\nseed: 3\n"),
              HasSubstr(path("top.yaml") + ":2:7: seed: a config with a base has only"));
  EXPECT_THAT(error_of("base: base.yaml\nset: [seed]\n"), HasSubstr("set: a config with a base"));
}

TEST_F(BaseConfig, MustBeAFile) {
  EXPECT_THAT(
      error_of("base: nowhere.yaml\n"),
      HasSubstr(path("top.yaml") + ":1:7: base: there is no config " + path("nowhere.yaml")));
  EXPECT_THAT(error_of("base: .\n"), HasSubstr("base: there is no config"));
  EXPECT_THAT(error_of("base: /dev/zero\n"),
              HasSubstr("base: '/dev/zero' leads to /dev/zero, which is outside"));
  EXPECT_THAT(error_of("base: [a]\n"), HasSubstr("base: expected the path of a config"));
  EXPECT_THAT(error_of("base:\n"), HasSubstr("base: expected the path of a config"));
}

TEST_F(BaseConfig, ThatIsItselfEnds) {
  write("top.yaml", "base: top.yaml\n");
  EXPECT_THAT(error_of("base: top.yaml\n"), HasSubstr("more than 8 configs in a chain"));
}

}  // namespace
}  // namespace seedframe
