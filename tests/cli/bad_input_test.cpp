// Bad input: a clear error before anything renders, exit code 2, nothing written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/cli/program.h"
#include "tests/fixtures/script.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class BadInputTest : public ProgramTest {
 protected:
  /// Submits a config and expects exit code 2, the message, no campaign folder and no Blender.
  void expect_refused(const std::string& config, const std::string& message,
                      std::vector<std::string> more = {}) {
    write("scene.yaml", config);
    std::vector<std::string> arguments = {"submit", "scene.yaml", "-o",
                                          "c",      "--blender",  kFakeBlender};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments, {R"(SEEDFRAME_FAKE={"starts_log": "starts.txt"})"});
    EXPECT_EQ(outcome.exit_code, 2) << config << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr(message)) << config;
    EXPECT_FALSE(exists("c")) << config;
    EXPECT_FALSE(exists("starts.txt")) << config;
  }

  static std::string with_object(const std::string& object) {
    return "seedframe: 1\ncategories: [gear]\ncamera: {distance_m: 1}\nobjects:\n  o: " + object +
           "\n";
  }
};

TEST_F(BadInputTest, MissingFilesAndAssets) {
  EXPECT_EQ(run({"submit", "none.yaml"}).exit_code, 2);
  EXPECT_THAT(run({"check", "none.yaml"}).errors, HasSubstr("none.yaml: No such file"));
  expect_refused(with_object("{asset: gaer}"), "scene.yaml:5:");
  expect_refused(with_object("{asset: gaer}"), "did you mean 'gear'?");
  expect_refused(with_object("{asset: gear, material: nickel_}"), "there is no material 'nickel_'");
}

TEST_F(BadInputTest, ConfigsThatAreNoFiles) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.yaml").c_str(), 0600), 0);
  for (const std::string config : {"pipe.yaml", "/dev/zero"}) {
    const Outcome outcome = run({"check", config});
    EXPECT_EQ(outcome.exit_code, 2) << config;
    EXPECT_THAT(outcome.errors, HasSubstr("cannot read " + config + ": it is a device, a pipe"));
  }
}

TEST_F(BadInputTest, NumbersThatMakeNoScene) {
  expect_refused(with_object("{asset: gear, scale: .nan}"), "a number must be finite");
  expect_refused(with_object("{asset: gear, scale: -1}"), "scale must be above 0");
  expect_refused(with_object("{asset: gear, scale: 0/0}"), "a number must be finite");
  expect_refused(with_object("{asset: gear, count: 99999}"), "a count must be from 0 to 32767");
  expect_refused(with_object("{asset: gear}") + "render: {width: 0}\n", "render.width");
  expect_refused(with_object("{asset: gear}") + "render: {height: -4}\n", "render.height");
}

TEST_F(BadInputTest, DistributionsAndFormulas) {
  expect_refused(with_object("{asset: gear, scale: {gaussian: [0, 1]}}"), "unknown distribution");
  expect_refused(with_object("{asset: gear, scale: {uniform: [2, 1]}}"), "min <= max");
  expect_refused(with_object("{asset: gear, scale: b, variables: {a: b, b: a}}"),
                 "refer to each other in a circle: a → b → a");
}

TEST_F(BadInputTest, AFrameFarIntoTheCampaignIsFoundBeforeTheFirstIsRendered) {
  expect_refused(with_object("{asset: gear, scale: 40 - scene_index}") + "scenes: 50\n",
                 "scale must be above 0, found 0 (scene 40");
}

TEST_F(BadInputTest, AMistakeOfTheConfigComesBeforeWhatIsToBeSaidOfBlender) {
  write_config("scene.yaml",
               with_object("{asset: gear, scale: 40 - scene_index}") + "scenes: 50\n");
  write_script(folder_ / "new_blender", "#!/bin/sh\necho Blender 4.3.1\n");
  for (const std::string blender : {"/no/blender", "./new_blender"}) {
    const Outcome outcome = run({"submit", "scene.yaml", "-o", "c", "--blender", blender});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.errors, HasSubstr("scale must be above 0, found 0 (scene 40"));
    EXPECT_THAT(outcome.errors, Not(HasSubstr("lender")));
    EXPECT_FALSE(exists("c"));
  }
}

TEST_F(BadInputTest, EmptyAndDamagedMeshes) {
  std::filesystem::create_directories(folder_ / "parts/hollow");
  write("parts/hollow/mesh.drc", "DRACO");
  write("parts/hollow/asset.json", "{}");
  expect_refused("asset_folders: [parts]\n" + with_object("{asset: hollow}"), "hollow");
  write("empty.obj", "# nothing\n");
  const Outcome outcome = run({"asset", "import", "empty.obj", "--root", "parts", "--name", "e"});
  EXPECT_EQ(outcome.exit_code, 2) << outcome.errors;
  EXPECT_FALSE(exists("parts/e"));
}

TEST_F(BadInputTest, Views) {
  write("view.yaml",
        with_object("{asset: gear}") + "image:\n  view: AgX\n  ocio_config: " + kOcioConfig + "\n");
  const Outcome checked = run({"check", "view.yaml", "--blender", kFakeBlender});
  EXPECT_EQ(checked.exit_code, 2);
  EXPECT_THAT(checked.errors, HasSubstr("view.yaml:7:3: image: "));
  EXPECT_THAT(checked.errors, HasSubstr("AgX"));
  expect_refused(
      with_object("{asset: gear}") + "image: {view: Filmc, ocio_config: " + kOcioConfig + "}\n",
      "did you mean 'Filmic'?");
}

TEST_F(BadInputTest, OutputThatCannotBeWritten) {
  write_config("scene.yaml", with_object("{asset: gear}"));
  const Outcome nowhere =
      run({"submit", "scene.yaml", "-o", "/proc/nowhere/c", "--blender", kFakeBlender});
  EXPECT_EQ(nowhere.exit_code, 2) << nowhere.errors;
  EXPECT_THAT(nowhere.errors, HasSubstr("/proc/nowhere"));
  std::filesystem::create_directories(folder_ / "full");
  write("full/thesis.tex", "precious");
  const Outcome full = run({"submit", "scene.yaml", "-o", "full", "--blender", kFakeBlender});
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_THAT(full.errors, HasSubstr("is not empty"));
  EXPECT_EQ(*read_file(folder_ / "full/thesis.tex"), "precious");
}

TEST_F(BadInputTest, Blenders) {
  write("scene.yaml", with_object("{asset: gear}"));
  const Outcome missing = run({"submit", "scene.yaml", "-o", "c", "--blender", "/no/blender"});
  EXPECT_EQ(missing.exit_code, 4);
  EXPECT_THAT(missing.errors, HasSubstr("--blender"));
  write_script(folder_ / "old_blender", "#!/bin/sh\necho Blender 2.93.4\n");
  const Outcome old = run({"submit", "scene.yaml", "-o", "c", "--blender", "./old_blender"});
  EXPECT_EQ(old.exit_code, 4);
  EXPECT_THAT(old.errors, HasSubstr("3.3"));
  EXPECT_FALSE(exists("c"));
}

TEST_F(BadInputTest, ABlenderThatIsNotTestedIsSaidSoAndNotRefused) {
  write_config("scene.yaml", with_object("{asset: gear}"));
  write_script(folder_ / "new_blender", "#!/bin/sh\necho Blender 4.3.1\n");
  const Outcome outcome =
      run({"submit", "scene.yaml", "-o", "c", "--dry-run", "--blender", "./new_blender"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("Blender 4.3.1 is not a version that Seedframe is tested"));
  EXPECT_THAT(outcome.output, HasSubstr("nothing was written"));
  EXPECT_FALSE(exists("c"));
}

TEST_F(BadInputTest, CommandLines) {
  EXPECT_THAT(run({"sumbit"}).errors,
              HasSubstr("there is no verb 'sumbit' (did you mean 'submit'?)"));
  EXPECT_THAT(run({"submit", "x.yaml", "--wrokers", "2"}).errors,
              HasSubstr("did you mean '--workers'?"));
  EXPECT_THAT(run({"export", "c", "--format", "yolo"}).errors,
              HasSubstr("did you mean 'yolo-detect', 'yolo-segment', 'yolo-obb' or 'yolo-pose'?"));
  EXPECT_THAT(run({"explain", "c", "-1"}).errors,
              HasSubstr("FRAME: expected a number of 0 or more, found '-1'\n"));
  EXPECT_EQ(run({"submit"}).exit_code, 2);
  EXPECT_EQ(run({"status", "nowhere"}).exit_code, 2);
  EXPECT_THAT(run({"status", "nowhere"}).errors, HasSubstr("there is no campaign here"));
  EXPECT_EQ(run({"--help"}).exit_code, 0);
  for (const char* verb :
       {"submit", "resume", "status", "explain", "export", "check", "asset", "doctor"}) {
    const Outcome outcome = run({verb, "--help"});
    EXPECT_EQ(outcome.exit_code, 0) << verb;
    EXPECT_THAT(outcome.output, HasSubstr("Example: seedframe ")) << verb;
  }
}

TEST_F(BadInputTest, ExportFormats) {
  EXPECT_THAT(run({"export", "c", "--format", "cocoo"}).errors, HasSubstr("did you mean 'coco'?"));
  EXPECT_THAT(run({"export", "c", "--format", "coco", "--split", "train=0.8"}).errors,
              HasSubstr("there is no campaign here"));
  EXPECT_THAT(run({"export", "c", "--format", "coco", "--split", "train=0.8,vla=0.2"}).errors,
              HasSubstr("did you mean 'val'?"));
  EXPECT_THAT(run({"export", "c", "--format", "coco", "--split", "train=0.8,val=0.3"}).errors,
              HasSubstr("must add up to 1"));
}

TEST_F(BadInputTest, OverridesAreCheckedLikeTheConfig) {
  expect_refused(with_object("{asset: gear}"), "--set render.samples=0: render.samples",
                 {"--set", "render.samples=0"});
  expect_refused(with_object("{asset: gear}"), "did you mean 'render'?", {"--set", "rendr.x=0"});
}

TEST_F(BadInputTest, WhatOverridesTakeAway) {
  write("scene.yaml", with_object("{asset: gear, count: crowd}") +
                          "scenes: 3\nvariables: {scene: {crowd: {integer: [1, 2]}}}\n"
                          "sweep: {axes: {a: {b: [1, 2]}}}\nworld: {colour: 1}\n");
  write("graphs.jsonl", "{\"crowd\": 1}\n{\"crowd\": 2}\n");
  const auto check = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"check", "scene.yaml", "--set", "sweep=null"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  EXPECT_THAT(check({}).errors, HasSubstr("world.colour: unknown key"));
  EXPECT_THAT(check({"--set", "world=null"}).output, HasSubstr("3 scenes"));
  EXPECT_THAT(check({"--set", "world.colour=null"}).output, HasSubstr("3 scenes"));
  EXPECT_THAT(check({"--set", "world=null", "--set", "scenes=null"}).output, HasSubstr("1 scenes"));
  EXPECT_THAT(check({"--set", "world=null", "--set", "graphs=graphs.jsonl"}).output,
              HasSubstr("2 scenes"));
  EXPECT_THAT(
      check({"--set", "world=null", "--set", "graphs=graphs.jsonl", "--set", "scenes=3"}).errors,
      HasSubstr("scenes and graphs exclude each other"));
}

TEST_F(BadInputTest, MistakesComeInTheOrderOfTheirLines) {
  write("scene.yaml",
        "seedframe: 1\nrender:\n  sampels: 3\n  width: many\n  hieght: 2\nlights: {a: {powr: 1}}\n"
        "camera: {distance: 1}\n");
  const std::string errors = run({"check", "scene.yaml"}).errors;
  std::size_t after = 0;
  for (const char* place : {"yaml:3:", "yaml:4:", "yaml:5:", "yaml:6:", "yaml:7:"}) {
    const std::size_t found = errors.find(place, after);
    ASSERT_NE(found, std::string::npos) << place << "\n" << errors;
    after = found;
  }
}

TEST_F(BadInputTest, WithJsonErrorsAreJson) {
  write("scene.yaml", with_object("{asset: gear, hidden: 3}") + "lights: {a: {powr: 1}}\n");
  const Outcome outcome = run({"check", "scene.yaml", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  const Json error = Json::parse(outcome.output).at("error");
  EXPECT_EQ(error.at("exit_code"), 2);
  EXPECT_EQ(error.at("messages").size(), 3u);
  EXPECT_EQ(error.at("messages").at(0),
            "scene.yaml:5:28: objects.o.hidden: unknown key (did you mean 'hidden_from'?)");
  for (const auto& message : error.at("messages")) {
    EXPECT_THAT(outcome.errors, HasSubstr("seedframe: error: " + message.get<std::string>()));
  }
  EXPECT_EQ(Json::parse(run({"status", "nowhere", "--json"}).output).at("error").at("exit_code"),
            2);
  EXPECT_EQ(Json::parse(run({"status", "--jsn", "--json"}).output).at("error").at("exit_code"), 2);
  EXPECT_EQ(run({"check", "scene.yaml"}).output, "");
}

}  // namespace
}  // namespace seedframe
