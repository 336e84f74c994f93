// Graphs: the values of variables from a file of JSON lines instead of draws.

#include "draws/graphs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr const char* kVariables = R"(seedframe: 1
seed: 6
variables:
  campaign: {hue: {uniform: [0, 360]}}
  scene:
    reach: {uniform: [0.1cm, 5cm]}
    kind: {choice: [cube, sphere]}
    corner: [{uniform: [0, 1]}, 0.5, 0]
    tint: {hsv: [hue, 0.5, 0.5]}
    twice: 2 * reach
  frame: {turn: {uniform: [0, 360]}}
objects:
  boxes:
    asset: "${kind}"
    category: none
    count: 2
    variables: {spin: {uniform: [0, 360]}, at: [{uniform: [-1, 1]}, 0, 0]}
    position: corner * 1m + at * 1m
    rotation_deg: [0, 0, spin]
    material: paint
    objects:
      lids: {asset: cone, category: none, count: 2, variables: {tilt: {uniform: [0, 90]}},
             rotation_deg: [tilt, 0, 0]}
materials: {paint: {base_color: tint}}
lights: {lamp: {variables: {watts: {uniform: [1, 2]}}, power: watts}}
camera: {variables: {near: {uniform: [2, 3]}}, distance_m: near, azimuth_deg: turn}
)";

/// A config with explicit graphs, in a folder that is gone afterwards.
class GraphsTest : public ::testing::Test {
 protected:
  /// Relative to the folder's config.
  std::string write(const std::string& lines) {
    EXPECT_TRUE(write_file(folder_ / "graphs.jsonl", lines));
    return std::string(kVariables) + "graphs: graphs.jsonl\n";
  }
  std::vector<ExpandedFrame> frames(const std::string& lines, const std::string& more = "") {
    return all_frames(write(lines) + more, folder_ / "scene.yaml");
  }
  std::string error(const std::string& lines) {
    return scene_error(write(lines), folder_ / "scene.yaml");
  }
  std::string file() const { return (folder_ / "graphs.jsonl").string(); }

 private:
  ScratchFolder folder_;
};

TEST_F(GraphsTest, EveryLineIsAScene) {
  const auto all = frames("{}\n{\"reach\": 0.25}\n{}\n", "frames_per_scene: 2\n");
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[2].graph.at("reach"), 0.25);
  EXPECT_EQ(all[3].graph.at("reach"), 0.25);
  EXPECT_NE(all[1].graph.at("reach"), 0.25);
  EXPECT_NE(all[4].graph.at("reach"), 0.25);
}

TEST_F(GraphsTest, ALineThatGivesNothingDrawsAsWithoutGraphs) {
  const auto plain = all_frames(std::string(kVariables) + "scenes: 2\n");
  const auto given = frames("{}\n{}\n");
  ASSERT_EQ(given.size(), 2u);
  EXPECT_EQ(given[0].id, plain[0].id);
  EXPECT_EQ(given[1].id, plain[1].id);
}

TEST_F(GraphsTest, ValuesReplaceDrawsAtEveryLevel) {
  const Json graph = frames(R"({"hue": 120, "reach": 0.5, "kind": "sphere", "corner": [1, 2, 3],)"
                            R"( "turn": 45, "lights.lamp.watts": 7, "camera.near": 9})")
                         .at(0)
                         .graph;
  EXPECT_EQ(graph.at("hue"), 120.0);
  EXPECT_EQ(graph.at("reach"), 0.5);
  EXPECT_EQ(graph.at("twice"), 1.0);  // formulas follow
  EXPECT_EQ(graph.at("kind"), "sphere");
  EXPECT_EQ(graph.at("corner"), Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(graph.at("turn"), 45.0);
  EXPECT_EQ(graph.at("lights.lamp.watts"), Json::array({7.0}));
  EXPECT_EQ(graph.at("camera.near"), 9.0);
}

TEST_F(GraphsTest, WhatIsGivenIsWhatTheFrameShows) {
  const FrameSpec spec = frames(R"({"tint": [0.1, 0.2, 0.3], "camera.near": 9,)"
                                R"( "lights.lamp.watts": 7, "corner": [0, 0, 0],)"
                                R"( "objects.boxes.at": [[-1, 0, 0], [1, 0, 0]]})")
                             .at(0)
                             .spec;
  EXPECT_EQ(spec.materials.at(0).base_color, (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(spec.lights.at(0).power, 7.0);
  const Eigen::Vector3d apart = spec.instances.at(3).camera_from_object.translation() -
                                spec.instances.at(0).camera_from_object.translation();
  EXPECT_NEAR(apart.norm(), 2.0, 1e-12);
}

TEST_F(GraphsTest, ALineMayNameTheSceneWhoseDrawsAreLeft) {
  const auto drawn = frames("{}\n{}\n{}\n");
  const auto named = frames("{\"@scene\": 2}\n{\"@scene\": 0}\n{\"@scene\": 2, \"reach\": 0.5}\n");
  EXPECT_EQ(named.at(0).id, drawn.at(2).id);
  EXPECT_EQ(named.at(1).id, drawn.at(0).id);
  EXPECT_EQ(named.at(2).graph.at("reach"), 0.5);
  EXPECT_EQ(named.at(2).graph.at("turn"), drawn.at(2).graph.at("turn"));
  EXPECT_EQ(named.at(2).scene, 2) << "in the campaign it is that of its line";
}

TEST_F(GraphsTest, ALineMaySayHowItIsRendered) {
  const auto made = frames(
      R"({"@render": {"samples": 9, "denoise": true, "crop": [1, 2, 30, 40], "depth": true}})"
      "\n{}\n"
      R"({"@render": {"denoise": false}})",
      "render: {denoise: oidn_fast}\n");
  const RenderSettings& first = made.at(0).spec.render;
  EXPECT_EQ(first.samples, 9);
  EXPECT_EQ(first.denoise, Denoise::kOidnFast) << "the config's own";
  EXPECT_EQ(first.region, (PixelRect{1, 2, 30, 40}));
  EXPECT_TRUE(first.depth);
  EXPECT_EQ(made.at(1).spec.render.denoise, Denoise::kOidnFast);
  EXPECT_FALSE(made.at(1).spec.render.depth);
  EXPECT_EQ(made.at(2).spec.render.denoise, Denoise::kOff);
  EXPECT_EQ(frames(R"({"@render": {"denoise": true}})").at(0).spec.render.denoise, Denoise::kOidn);
}

TEST_F(GraphsTest, WhatALineSaysBesideValuesIsChecked) {
  EXPECT_THAT(error(R"({"@scene": -1})"), HasSubstr("@scene: expected a whole number"));
  EXPECT_THAT(error(R"({"@render": 3})"), HasSubstr("@render: expected an object"));
  EXPECT_THAT(error(R"({"@render": {"sampels": 3}})"), HasSubstr("did you mean 'samples'?"));
  EXPECT_THAT(error(R"({"@render": {"samples": 0}})"), HasSubstr("from 1 to 65536"));
  EXPECT_THAT(error(R"({"@render": {"denoise": "oidn"}})"), HasSubstr("true or false"));
  EXPECT_THAT(error(R"({"@render": {"crop": [0, 0, 100000, 1]}})"),
              HasSubstr("reaches beyond the image"));
  EXPECT_THAT(error(R"({"@render": {"crop": [2147483647, 0, 2147483647, 1]}})"),
              HasSubstr("reaches beyond the image"));
}

TEST_F(GraphsTest, OfAFileThatGrowsOnlyWholeLinesCount) {
  const auto size = [&](const std::string& text) {
    write(text);
    const auto graphs = Graphs::open(file(), Graphs::Kind::kGrowing);
    return graphs ? graphs->size() : -1;
  };
  EXPECT_EQ(size(""), 0);
  EXPECT_EQ(size("{}"), 0);
  EXPECT_EQ(size("{}\n{\"@sc"), 1);
  EXPECT_EQ(size("{}\n{}\n"), 2);
}

TEST(GraphLine, IsReadBackAsItWasAsked) {
  EXPECT_EQ(graph_line(Json{{"turn", 0.1}}, 7, {}), R"({"@scene":7,"turn":0.1})");
  EXPECT_EQ(graph_line(Json::object(), 0, {.samples = 4, .denoise = false}),
            R"({"@render":{"denoise":false,"samples":4},"@scene":0})");
}

TEST_F(GraphsTest, AListHasAValueForEachCopyAndASingleValueIsForAll) {
  const Json graph = frames(R"({"objects.boxes.spin": [10, 20], "objects.boxes.at": [1, 2, 3],)"
                            R"( "objects.boxes.objects.lids.tilt": [1, 2, 3, 4, 99]})")
                         .at(0)
                         .graph;
  EXPECT_EQ(graph.at("objects.boxes.spin"), Json({10.0, 20.0}));
  EXPECT_EQ(graph.at("objects.boxes.at"), Json({{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}}));
  EXPECT_EQ(graph.at("objects.boxes.objects.lids.tilt"), Json({1.0, 2.0, 3.0, 4.0}));
}

TEST_F(GraphsTest, AListOfOneIsForOneCopy) {
  EXPECT_THAT(
      error(R"({"objects.boxes.spin": [10]})"),
      HasSubstr("the graph gives 'objects.boxes.spin' a list of 1, but there are more copies; "
                "for all of them, give the value without []"));
}

TEST_F(GraphsTest, ValuesThatAreGivenAreNotDrawn) {
  const auto all = frames("{\"reach\": 1}\n{}\n");
  EXPECT_FALSE(draws_by_name(all[0]).contains("variables.scene.reach"));
  EXPECT_TRUE(draws_by_name(all[1]).contains("variables.scene.reach"));
}

TEST_F(GraphsTest, OneLineLeavesNothingToTheNext) {
  const auto all = frames("{\"objects.boxes.spin\": [10, 20], \"kind\": \"cube\"}\n{}\n");
  const auto plain = all_frames(std::string(kVariables) + "scenes: 2\n");
  EXPECT_NE(all[0].id, plain[0].id);
  EXPECT_EQ(all[1].id, plain[1].id);
}

TEST_F(GraphsTest, FramesMayBeAskedForInAnyOrder) {
  const std::string text = write("{\"reach\": 1}\n{\"reach\": 2}\n{\"turn\": 3}\n");
  const std::filesystem::path config = std::filesystem::path(file()).parent_path() / "s.yaml";
  auto forwards = expander_of(text, config);
  auto backwards = expander_of(text, config);
  std::vector<std::string> ids;
  for (const std::int64_t frame : {0, 1, 2}) ids.push_back(frame_of(*forwards, frame).id);
  for (const std::int64_t frame : {2, 1, 0, 2}) {
    EXPECT_EQ(frame_of(*backwards, frame).id, ids[static_cast<std::size_t>(frame)]);
  }
}

TEST_F(GraphsTest, ABadLineSpoilsNoOther) {
  const std::string text = write("{\"reach\": 1}\n{\"hue\": 5, \"reach\": true}\n");
  auto expander = expander_of(text, std::filesystem::path(file()).parent_path() / "s.yaml");
  ASSERT_TRUE(expander);
  const std::string before = frame_of(*expander, 0).id;
  EXPECT_FALSE(expander->expand(1));
  EXPECT_EQ(frame_of(*expander, 0).id, before);
  EXPECT_FALSE(expander->expand(1));
}

TEST_F(GraphsTest, WhatExpansionWritesGivesTheSameFrames) {
  std::string lines;
  std::vector<std::string> ids;
  for (const ExpandedFrame& frame : all_frames(std::string(kVariables) + "scenes: 20\n")) {
    lines += canonical_json(frame.graph) + "\n";
    ids.push_back(frame.id);
  }
  const auto again = frames(lines);
  ASSERT_EQ(again.size(), ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(again[i].id, ids[i]);
    EXPECT_EQ(canonical_json(again[i].graph) + "\n", lines.substr(0, lines.find('\n') + 1));
    lines.erase(0, lines.find('\n') + 1);
  }
}

TEST_F(GraphsTest, ErrorsNameFileLineAndVariable) {
  struct Case {
    const char* line;
    const char* expected;
  };
  const std::vector<Case> cases = {
      {R"({"raech": 1})", "the config has no variable 'raech' (did you mean 'reach'?)"},
      {R"({"reach": "far"})", "reach: expected a number, found \"far\""},
      {R"({"reach": true})", "reach: expected a number, found true"},
      {R"({"reach": null})", "reach: expected a number"},
      {R"({"reach": [1, 2]})", "reach: expected one value: this variable has no copies"},
      {R"({"kind": 3})", "kind: expected a name, found 3"},
      {R"({"corner": 3})", "corner: expected [x, y, z], found 3"},
      {R"({"corner": [1, 2]})", "corner: expected [x, y, z]"},
      {R"({"corner": [1, 2, "3"]})", "corner: expected [x, y, z]"},
      {R"({"objects.boxes.spin": []})", "expected a value for each copy, found none"},
      {R"({"objects.boxes.spin": [1, "2"]})", "objects.boxes.spin: expected a number"},
      {R"({"objects.boxes.at": [[1, 2, 3], 4]})", "objects.boxes.at: expected [x, y, z]"},
      {"[1]", "expected an object"},
      {"3", "expected an object"},
      {"{\"reach\": 1", "is not valid JSON"},
      {"{\"reach\": NaN}", "is not valid JSON"},
      {"{\"reach\": 1e999}", "is not valid JSON"},
      {"\xff\xfe", "is not valid JSON"},
  };
  for (const Case& c : cases) {
    const std::string message = error("{}\n\n" + std::string(c.line) + "\n");
    EXPECT_THAT(message, HasSubstr(file() + ":3")) << c.line;
    EXPECT_THAT(message, HasSubstr(c.expected)) << c.line;
    EXPECT_THAT(message, ::testing::Not(HasSubstr("json.exception"))) << c.line;
  }
}

TEST_F(GraphsTest, ALongValueIsNotRepeatedInFull) {
  const std::string message = error("{\"reach\": \"" + std::string(100'000, 'x') + "\"}");
  EXPECT_LT(message.size(), 500u);
}

TEST_F(GraphsTest, AListThatIsTooShortIsAnErrorOfTheFrame) {
  EXPECT_THAT(
      error(R"({"objects.boxes.objects.lids.tilt": [1, 2, 3]})"),
      HasSubstr("the graph gives 'objects.boxes.objects.lids.tilt' a list of 3, but there are "
                "more copies"));
}

TEST_F(GraphsTest, AnImpossibleValueIsAnErrorOfTheFrame) {
  EXPECT_THAT(error(R"({"kind": "cupe"})"), HasSubstr("did you mean 'cube'?"));
  EXPECT_THAT(error(R"({"camera.near": -1})"), HasSubstr("distance_m must be above 0"));
}

TEST_F(GraphsTest, EmptyLinesAndEndsOfLinesDoNotMatter) {
  const auto all = frames("\r\n{\"reach\": 1}\r\n\n   \n{\"reach\": 2}");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].graph.at("reach"), 1.0);
  EXPECT_EQ(all[1].graph.at("reach"), 2.0);
}

TEST_F(GraphsTest, AFileWithoutLinesIsAnError) {
  EXPECT_THAT(error(""), HasSubstr(file() + " has no lines"));
  EXPECT_THAT(error("\n \n\r\n"), HasSubstr(file() + " has no lines"));
}

TEST(Graphs, AFileThatIsNotThereIsAnError) {
  EXPECT_FALSE(Graphs::open("nowhere/graphs.jsonl"));
  EXPECT_THAT(scene_error("seedframe: 1\ngraphs: nowhere.jsonl\ncamera: {distance_m: 1}\n"),
              HasSubstr("scene.yaml:2:9: graphs: expected a file of JSON lines, found "
                        "'nowhere.jsonl'"));
}

TEST(Graphs, ExcludeScenesAndSweeps) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "g.jsonl", "{}\n"));
  for (const char* key : {"scenes: 3", "sweep: {values: {a: [1, 2]}}"}) {
    EXPECT_THAT(scene_error(std::string("seedframe: 1\ngraphs: g.jsonl\ncamera: {distance_m: "
                                        "1}\n") +
                                key + "\n",
                            folder / "scene.yaml"),
                HasSubstr("and graphs exclude each other"));
  }
}

}  // namespace
}  // namespace seedframe
