// A campaign that says how wrong its frames may be, with the fake Blender: what is chosen is kept.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class QualityTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("gears.yaml", R"(seedframe: 1
name: gears
scenes: 9
categories: [gear]
render: {width: 32, height: 24, samples: 256}
quality: {metric: rmse8, max_error: 0.001}
labels: {check: false}
objects: {gears: {asset: gear, position: [{uniform: [-0.1, 0.1]}, 0, 0]}}
camera: {position: [0, 0, 0.4], target: [0, 0, 0]}
)");
  }

  Outcome with_fake(std::vector<std::string> arguments, const std::string& fake = "{}") {
    arguments.insert(arguments.end(), {"--blender", kFakeBlender});
    return run(arguments, {"SEEDFRAME_FAKE=" + fake});
  }

  int samples_of(const std::string& folder, int frame) {
    const std::string path = fmt::format("{}/frames/000/{:06}/frame.json", folder, frame);
    const auto spec = parse_json(read_file(folder_ / path).value(), path);
    return spec ? spec->at("render").at("samples").get<int>() : 0;
  }
};

TEST_F(QualityTest, ChoosesTheSameWhateverTheWorkers) {
  const Outcome one = with_fake({"submit", "gears.yaml", "-o", "one", "--workers", "1"});
  ASSERT_EQ(one.exit_code, 0) << one.errors;
  EXPECT_THAT(one.errors, HasSubstr("calibrated by "));
  const Outcome three = with_fake({"submit", "gears.yaml", "-o", "three", "--workers", "3"});
  ASSERT_EQ(three.exit_code, 0) << three.errors;
  EXPECT_EQ(status("one")["dataset_hash"], status("three")["dataset_hash"]);
  for (int frame = 0; frame < 9; ++frame) {
    EXPECT_GE(samples_of("one", frame), 1);
    EXPECT_LE(samples_of("one", frame), 256);
  }
}

TEST_F(QualityTest, WhatWasChosenStaysTheCampaigns) {
  ASSERT_EQ(with_fake({"submit", "gears.yaml", "-o", "c", "--frames", "4"}).exit_code, 0);
  // Nothing is calibrated again: the rest is rendered with what the store knows.
  const Outcome resumed = with_fake({"resume", "c"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  ASSERT_EQ(with_fake({"submit", "gears.yaml", "-o", "whole"}).exit_code, 0);
  EXPECT_EQ(status("c")["dataset_hash"], status("whole")["dataset_hash"]);
  const Outcome audited = with_fake({"audit", "c", "--frames", "2", "--quiet"});
  EXPECT_EQ(audited.exit_code, 0) << audited.output << audited.errors;
}

TEST_F(QualityTest, SaysOfHowManyFramesItCannotBeHad) {
  // Every pixel of every rendering is another one, and no number of samples helps.
  const Outcome outcome =
      with_fake({"submit", "gears.yaml", "-o", "c", "--set", "render.samples=2"},
                R"({"brighter_frames": [0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20]})");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("the error is likely to be above quality.max_error"));
}

TEST_F(QualityTest, CannotDoWithoutPilots) {
  const Outcome outcome =
      with_fake({"submit", "gears.yaml", "-o", "c"}, R"({"fail_frames": "all"})");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.errors,
              HasSubstr("no pilot frame could be rendered to calibrate the quality"));
  EXPECT_FALSE(exists("c"));
}

TEST_F(QualityTest, DoesNotCalibrateWhatCannotBeSubmitted) {
  std::filesystem::create_directories(folder_ / "c");
  write("c/mine.txt", "");
  const Outcome outcome = with_fake({"submit", "gears.yaml", "-o", "c"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("c is not empty"));
  EXPECT_EQ(outcome.errors.find("calibrat"), std::string::npos);
}

TEST_F(QualityTest, ADryRunOnlySaysThatItWould) {
  const Outcome outcome = with_fake({"submit", "gears.yaml", "--dry-run"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output,
              HasSubstr("what each frame needs for rmse8 of 0.001 would be found out first"));
}

TEST_F(QualityTest, AFrameBesideItHasTheSamplesThatAreAskedFor) {
  ASSERT_EQ(with_fake({"submit", "gears.yaml", "-o", "c", "--quiet"}).exit_code, 0);
  const Outcome asked = with_fake({"render", "c", "--frame", "0", "--samples", "77"});
  ASSERT_EQ(asked.exit_code, 0) << asked.errors;
  EXPECT_THAT(asked.output, HasSubstr("at 77 samples"));
  const Outcome own = with_fake({"render", "c", "--frame", "0"});
  EXPECT_THAT(own.output, HasSubstr(fmt::format("at {} samples", samples_of("c", 0))));
}

TEST_F(QualityTest, IsWhatVerifyErrorHoldsTheFramesTo) {
  ASSERT_EQ(with_fake({"submit", "gears.yaml", "-o", "c", "--quiet"}).exit_code, 0);
  const Outcome outcome =
      with_fake({"verify-error", "c", "--frames", "3", "--quiet"}, R"({"brighter_frames": "all"})");
  EXPECT_EQ(outcome.exit_code, 10) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("within rmse8 of 0.001"));
}

}  // namespace
}  // namespace seedframe
