// seedframe compare, over campaigns of the fake Blender that differ in one thing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kCompared = R"(seedframe: 1
name: compared
seed: 3
scenes: 4
frames_per_scene: 3
categories: [gear]
render: {width: 32, height: 24, samples: 1, passes: [depth, normal]}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
camera: {distance_m: {uniform: [0.2, 0.5]}}
labels: {check: false}
)";
constexpr std::size_t kComparedFrames = 12;

class CompareTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("compared.yaml", kCompared);
    submit("a");
  }
  void submit(const std::string& folder, const std::string& fake = "{}",
              std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"submit", "compared.yaml", "-o",
                                          folder,   "--blender",     kFakeBlender};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments, {"SEEDFRAME_FAKE=" + fake});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
  Outcome compare(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"compare", "a", "b"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(CompareTest, TheSameCampaignTwice) {
  submit("b", "{}", {"--workers", "1"});
  const Outcome outcome = compare();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("12 frames are identical: dataset hash " +
                                        status("a").at("dataset_hash").get<std::string>()));
}

TEST_F(CompareTest, ADifferenceOfTheLastBitIsRounding) {
  submit("b", R"({"last_bit_frames": [5]})");
  const Outcome outcome = compare();
  EXPECT_EQ(outcome.exit_code, 6) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("frame 5: other pixels (rounding)"));
  EXPECT_THAT(outcome.output, HasSubstr("combined 1 of 768 pixels, at most"));
  EXPECT_THAT(outcome.output, HasSubstr("11 frames are identical, 1 other pixels"));
  EXPECT_EQ(compare({"--ulp", "0"}).exit_code, 7) << "within the tolerance still";
}

TEST_F(CompareTest, ABrighterFrameIsJudgedByTheTolerance) {
  submit("b", R"({"brighter_frames": [5], "last_bit_frames": [7]})");
  EXPECT_EQ(compare({"--rms", "0.1", "--psnr", "30"}).exit_code, 7);
  EXPECT_EQ(compare().exit_code, 9) << "0.02 everywhere is more than an RMS of 0.005";
  EXPECT_EQ(compare({"--rms", "0.1", "--psnr", "30", "--pixels", "0.5"}).exit_code, 9);
}

TEST_F(CompareTest, OtherLabelsAreNamed) {
  submit("b", R"({"other_label_frames": [2]})");
  const Outcome outcome = compare({"--images", "pictures"});
  EXPECT_EQ(outcome.exit_code, 8) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("index 1 of 768 pixels"));
  EXPECT_THAT(outcome.output, HasSubstr("labels.json differs"));
  EXPECT_TRUE(exists("pictures/000002.png"));
  EXPECT_FALSE(exists("pictures/000003.png"));
}

TEST_F(CompareTest, WhatWasAskedForOtherwiseIsSaid) {
  submit("b", "{}", {"--set", "render.samples=2"});
  const Outcome outcome = compare({"--json", "--frames", "2"});
  EXPECT_EQ(outcome.exit_code, 9) << "ten frames were not looked at";
  const Json json = Json::parse(outcome.output);
  EXPECT_EQ(json.at("identical"), 0);
  ASSERT_EQ(json.at("frames").size(), kComparedFrames);
  EXPECT_EQ(json.at("frames").at(1).at("spec"), Json::parse(R"(["render.samples: 1, here 2"])"));
  EXPECT_FALSE(json.at("frames").at(2).contains("spec"));
  EXPECT_EQ(compare().exit_code, 0) << "the fake's pixels do not depend on it";
}

TEST_F(CompareTest, WhatItWasMadeWithIsSaid) {
  submit("b", R"({"last_bit_frames": [5], "kernel": "avx"})");
  EXPECT_THAT(compare().output, HasSubstr("made with kernel avx instead of avx2"));
}

TEST_F(CompareTest, FramesThatOneLacks) {
  submit("b", "{}", {"--frames", "8"});
  const Outcome outcome = compare();
  EXPECT_EQ(outcome.exit_code, 9) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("8 frames are identical, 4 only in the first"));
  EXPECT_THAT(outcome.output, Not(HasSubstr("frame 7:")));
}

TEST_F(CompareTest, BadInput) {
  const Outcome missing = compare();
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.errors, HasSubstr("seedframe: error:"));
  submit("b", R"({"last_bit_frames": [5]})");
  std::filesystem::resize_file(folder_ / "b/frames/000/000005/passes.exr", 100);
  const Outcome damaged = compare();
  EXPECT_EQ(damaged.exit_code, 5);
  EXPECT_THAT(damaged.errors, HasSubstr("000005/passes.exr"));
}

}  // namespace
}  // namespace seedframe
