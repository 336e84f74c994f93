// What a campaign would take, told by a dry run that makes a few of its frames.

#include <gmock/gmock.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class ForecastTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("gears.yaml",
                 "seedframe: 1\nscenes: 500\ncategories: [gear]\nlabels: {check: false}\n"
                 "render: {width: 64, height: 48}\nobjects: {o: {asset: gear}}\n"
                 "camera: {distance_m: 1}\n");
  }
  Outcome dry_run(const std::vector<std::string>& more, const std::string& faults = "{}") {
    std::vector<std::string> arguments = {"submit", "gears.yaml", "-o",
                                          "c",      "--blender",  kFakeBlender};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, {"SEEDFRAME_FAKE=" + faults});
  }
};

TEST_F(ForecastTest, IsToldByAFewFramesOfWhichNothingIsLeft) {
  const Outcome outcome = dry_run({"--dry-run", "--pilot", "4", "--quiet"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("500 of 500 frames would be rendered"));
  EXPECT_THAT(outcome.output, HasSubstr("by 4 frames that were made to tell"));
  EXPECT_FALSE(exists("c"));
}

TEST_F(ForecastTest, IsNotMadeUnlessAskedFor) {
  const Outcome outcome = dry_run({"--dry-run"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("--pilot 8 would make 8 frames"));
  EXPECT_EQ(outcome.output.find("were made"), std::string::npos);
}

TEST_F(ForecastTest, IsToldByFramesThatAreThereIfTheyAreLikeThese) {
  const Outcome some = run(
      {"submit", "gears.yaml", "-o", "c", "--blender", kFakeBlender, "--quiet", "--frames", "3"});
  ASSERT_EQ(some.exit_code, 0) << some.errors;
  EXPECT_THAT(some.output, HasSubstr("look: 'seedframe show c'"));
  const Outcome outcome = dry_run({"--dry-run"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("by 3 frames of the campaign that is there"));
  const Outcome others = dry_run({"--dry-run", "--set", "render.samples=7"});
  EXPECT_THAT(others.output, HasSubstr("--pilot 8 would make 8 frames to tell how long"))
      << "they have other samples";
}

TEST_F(ForecastTest, SaysWhatStandsInItsWay) {
  EXPECT_THAT(dry_run({"--pilot", "4"}).errors, HasSubstr("--dry-run"));
  const Outcome failing = dry_run({"--dry-run", "--pilot", "2", "--quiet"},
                                  R"({"fail_frames": "all", "fail_attempts": 9})");
  EXPECT_NE(failing.exit_code, 0);
  EXPECT_THAT(failing.errors, HasSubstr("frame 125 failed"));
  const Outcome quality =
      dry_run({"--dry-run", "--pilot", "2", "--set", "quality={metric: rmse8, max_error: 4}"});
  EXPECT_EQ(quality.exit_code, 2);
  EXPECT_THAT(quality.errors, HasSubstr("which a dry run leaves out"));
}

}  // namespace
}  // namespace seedframe
