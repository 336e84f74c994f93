// seedframe audit, over campaigns of a fake Blender whose pixels depend on what they should not.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kAudited = R"(seedframe: 1
name: audited
seed: 3
scenes: 3
frames_per_scene: 4
categories: [gear]
render: {width: 32, height: 24, samples: 1, passes: [depth, normal]}
asset_folders: [own]
material_folders: [textures]
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
  part: {asset: part, position: [0, 0, 0.1], category: none, material: Painted}
camera: {distance_m: {uniform: [0.2, 0.5]}}
labels: {check: false}
)";

class AuditTest : public ProgramTest {
 protected:
  void SetUp() override {
    make_part("cube");
    std::filesystem::create_directories(folder_ / "textures");
    std::filesystem::copy(SEEDFRAME_HOME "/materials/textures/Brick01",
                          folder_ / "textures/Painted");
    for (const char* map : {"Color", "NormalGL", "Roughness", "Metalness"}) {
      std::error_code error;  // not all are there
      std::filesystem::rename(
          folder_ / "textures/Painted" / ("Brick01_" + std::string(map) + ".png"),
          folder_ / "textures/Painted" / ("Painted_" + std::string(map) + ".png"), error);
    }
    write_config("audited.yaml", kAudited);
  }
  void submit(const std::string& fake = "{}", std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {
        "submit", "audited.yaml", "-o",         "c",         "--workers",
        "1",      "--blender",    kFakeBlender, "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments, {"SEEDFRAME_FAKE=" + fake});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
  Outcome audit(const std::string& fake = "{}", std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"audit", "c", "--blender", kFakeBlender, "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, {"SEEDFRAME_FAKE=" + fake});
  }
  Json report_json() const { return Json::parse(*read_file(folder_ / "c/audit/report.json")); }
  /// Of the first frame that has one: its kind and its text.
  std::pair<std::string, std::string> cause() const {
    const Json report = report_json();
    for (const Json& frame : report.at("frames")) {
      if (frame.contains("cause")) return {frame["cause"]["kind"], frame["cause"]["text"]};
    }
    return {};
  }
};

TEST_F(AuditTest, AGoodCampaignIsIdentical) {
  submit();
  ASSERT_EQ(run({"export", "c", "--format", "coco"}).exit_code, 0);
  const auto before = contents("c/frames");
  const Outcome outcome = audit("{}", {"--vary", "all"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("files: 12 frames with"));
  EXPECT_THAT(outcome.output, HasSubstr("export coco: 12 frames are what their source says"));
  EXPECT_THAT(outcome.output, HasSubstr("12 of 12 frames were audited: 12 identical"));
  EXPECT_EQ(report_json().at("rounds").size(), 3u) << "fresh workers and ISA are on their own";
  EXPECT_EQ(contents("c/frames"), before);
  EXPECT_TRUE(exists("c/audit/report.md"));
  EXPECT_FALSE(exists("c/audit/work"));
  // Two audits are compared as campaigns are.
  EXPECT_EQ(run({"compare", "c/audit/round-1", "c/audit/round-2"}).exit_code, 0);
}

TEST_F(AuditTest, TheSampleHasOneFrameOfEachSceneAndStaysTheSame) {
  submit();
  ASSERT_EQ(audit("{}", {"--frames", "3", "--vary", "none"}).exit_code, 0);
  const Json first = report_json().at("frames");
  ASSERT_EQ(first.size(), 3u);
  for (int scene = 0; scene < 3; ++scene) {
    EXPECT_EQ(first[static_cast<std::size_t>(scene)].at("frame").get<int>() / 4, scene);
  }
  ASSERT_EQ(audit("{}", {"--frames", "3", "--vary", "none"}).exit_code, 0);
  EXPECT_EQ(report_json().at("frames"), first);
}

TEST_F(AuditTest, OddFramesComeFirst) {
  submit(R"({"fail_frames": [7]})");
  ASSERT_EQ(audit("{}", {"--frames", "1", "--vary", "none"}).exit_code, 0);
  EXPECT_EQ(report_json().at("frames").at(0).at("frame"), 7);
  EXPECT_EQ(report_json().at("frames").at(0).at("why"), "was tried 2 times");
}

TEST_F(AuditTest, WhatFlipsAPixelIsFound) {
  for (const std::string condition : {"threads", "tmpdir", "locale", "timezone"}) {
    std::filesystem::remove_all(folder_ / "c");
    const std::string fake = fmt::format(R"({{"depends_on": ["{}"]}})", condition);
    submit(fake);
    const Outcome outcome = audit(fake, {"--frame", "0"});
    EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(6, 7, 9)) << outcome.output << outcome.errors;
    EXPECT_EQ(cause().first, "condition");
    EXPECT_EQ(cause().second, "the picture changes with " + condition);
    EXPECT_TRUE(exists("c/audit/differences/000000.png"));
  }
}

TEST_F(AuditTest, TheFramesBeforeAreFound) {
  const std::string fake = R"({"depends_on": ["history"]})";
  submit(fake);
  audit(fake, {"--frame", "0"});  // the only one that was rendered by a fresh worker
  EXPECT_EQ(cause().first, "history");
  EXPECT_THAT(cause().second, HasSubstr("its worker renders before change the picture"));
  audit(fake, {"--frame", "5"});
  EXPECT_EQ(cause().first, "history");
  EXPECT_THAT(cause().second, HasSubstr("only after the 5 frames that its worker had rendered"));
}

TEST_F(AuditTest, TwoConditionsThatFlipItOnlyTogetherAreFound) {
  const std::string fake = R"({"depends_on": ["locale and timezone"]})";
  submit(fake, {"--set", "scenes=1", "--set", "frames_per_scene=1"});
  audit(fake);
  EXPECT_EQ(cause().second, "the picture changes with locale, timezone");
}

TEST_F(AuditTest, PersistentDataIsFound) {
  const std::string fake = R"({"depends_on": ["persistent data"]})";
  submit(fake, {"--set", "determinism=none", "--set", "render.persistent_data=true"});
  const Outcome outcome = audit(fake, {"--frame", "5"});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_EQ(cause().first, "persistent data") << cause().second;
}

TEST_F(AuditTest, AnotherIsaIsFound) {
  const std::string fake = R"({"depends_on": ["kernel"]})";
  ASSERT_EQ(run({"submit", "audited.yaml", "-o", "c", "--blender", kFakeBlender},
                {"SEEDFRAME_FAKE=" + fake, "CYCLES_CPU_NO_AVX2=1"})
                .exit_code,
            0);
  const Outcome outcome = audit(fake, {"--frame", "5"});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_EQ(cause(), (std::pair<std::string, std::string>(
                         "kernels", "it was rendered again with kernel avx2 instead of avx")));
}

TEST_F(AuditTest, WhatIsNeverTheSameIsUnstable) {
  const std::string fake = R"({"depends_on": ["nothing"]})";
  submit(fake);
  audit(fake, {"--frame", "5"});
  EXPECT_EQ(cause().first, "unstable");
}

TEST_F(AuditTest, WhatNothingExplainsIsSaidToBeSo) {
  submit(R"({"last_bit_frames": "all"})");
  const Outcome outcome = audit("{}", {"--frame", "5"});
  EXPECT_EQ(outcome.exit_code, 6) << outcome.output;
  EXPECT_EQ(cause().first, "unknown");
}

TEST_F(AuditTest, ChangedInputsAreNamed) {
  submit();
  // Another seed in the campaign's copy of its config.
  const std::string config = *read_file(folder_ / "c/campaign.yaml");
  std::string other = config;
  other.replace(other.find("seed: 3"), 7, "seed: 4");
  write("c/campaign.yaml", other);
  EXPECT_EQ(audit("{}", {"--frames", "2"}).exit_code, 9);
  EXPECT_EQ(cause(), (std::pair<std::string, std::string>("inputs", "the seed is 4 instead of 3")));
  write("c/campaign.yaml", config);
  ASSERT_EQ(audit("{}", {"--frames", "2"}).exit_code, 0);

  // One texel. (A PNG of another colour in one pixel, written by PIL.)
  const std::string texture = (folder_ / "textures/Painted/Painted_Color.png").string();
  ASSERT_EQ(std::system(("/usr/bin/python3 -c \"from PIL import Image; p = '" + texture +
                         "'; i = Image.open(p); v = i.getpixel((3, 5)); i.putpixel((3, 5), "
                         "(v[0] ^ 1,) + v[1:]); i.save(p)\"")
                            .c_str()),
            0);
  EXPECT_EQ(audit("{}", {"--frames", "2"}).exit_code, 9);
  EXPECT_EQ(cause().first, "inputs");
  EXPECT_THAT(cause().second, HasSubstr("texture Painted/Painted_Color.png has changed"));

  // Another asset of the same name.
  make_part("cone");
  EXPECT_EQ(audit("{}", {"--frames", "2"}).exit_code, 9);
  EXPECT_THAT(cause().second, HasSubstr("asset part has changed"));
}

TEST_F(AuditTest, RottenFilesAndExportsAreFoundWithoutRendering) {
  submit();
  ASSERT_EQ(run({"export", "c", "--format", "coco"}).exit_code, 0);
  ASSERT_EQ(run({"audit", "c", "--frames", "0"}).exit_code, 0) << "and Blender is not looked for";
  std::string exported = *read_file(folder_ / "c/exports/coco/annotations/instances_train.json");
  exported.replace(exported.find("\"bbox\":[") + 8, 1, "9");
  write("c/exports/coco/annotations/instances_train.json", exported);
  std::string image = *read_file(folder_ / "c/frames/000/000004/image.png");
  image[image.size() / 2] = static_cast<char>(image[image.size() / 2] ^ 1);
  write("c/frames/000/000004/image.png", image);
  const Outcome outcome = run({"audit", "c", "--frames", "0"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.output, HasSubstr("1 are not as they were written"));
  EXPECT_THAT(outcome.output, HasSubstr("000004/image.png has changed"));
  EXPECT_THAT(outcome.output, HasSubstr("export coco: not what its source says"));
}

TEST_F(AuditTest, FramesWithTheSamePixelsAreFound) {
  submit();
  EXPECT_THAT(run({"audit", "c", "--frames", "0"}).output, Not(HasSubstr("duplicates")));
  // Nothing is drawn, and labels by geometry have no noise either.
  ASSERT_EQ(run({"submit", "audited.yaml", "-o", "still", "--set", "labels=geometry", "--set",
                 "frames_per_scene=2", "--set", "scenes=1", "--set", "objects.gears.count=1",
                 "--set", "objects.gears.position=[0, 0, 0]", "--set", "camera.distance_m=0.3"})
                .exit_code,
            0);
  const Outcome outcome = run({"audit", "still", "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("duplicates: frames 0, 1 have the same pixels"));
  EXPECT_THAT(outcome.output, HasSubstr("2 of 2 frames were audited: 2 identical"))
      << "and without Blender the sample is traced again";
}

TEST_F(AuditTest, BadInput) {
  EXPECT_EQ(run({"audit", "c"}).exit_code, 2);
  submit();
  const Outcome unknown = audit("{}", {"--vary", "thread"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors,
              HasSubstr("there is no condition 'thread' (did you mean 'threads'?)"));
  const Outcome missing = audit("{}", {"--frame", "99"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.errors, HasSubstr("the campaign has no frame 99"));
  const Outcome other = audit("{}", {"-o", "c/frames"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.errors, HasSubstr("c/frames is neither empty nor an audit"));
  EXPECT_TRUE(exists("c/frames/000"));
}

}  // namespace
}  // namespace seedframe
