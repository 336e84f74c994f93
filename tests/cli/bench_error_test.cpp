// seedframe bench error, as a user sees it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class BenchErrorTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("gears.yaml", R"(seedframe: 1
name: gears
scenes: 3
categories: [gear]
render: {width: 32, height: 24, samples: 4}
objects: {gears: {asset: gear, count: 2, scatter: {x: [-0.05, 0.05], y: [-0.05, 0.05]}}}
camera: {position: [0, 0, 0.4], target: [0, 0, 0]}
)");
  }

  Outcome bench(const std::vector<std::string>& more, const std::string& fake = "{}") {
    std::vector<std::string> arguments = {"bench", "error",   "gears.yaml", "-o",
                                          "out",   "--quiet", "--blender",  kFakeBlender};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, {"SEEDFRAME_FAKE=" + fake});
  }

  Json study() const {
    const auto json = parse_json(read_file(folder_ / "out/error.json").value(), "error.json");
    return json ? *json : Json();
  }

  Json variation(const std::string& name) const {
    const Json whole = study();
    for (const Json& each : whole["scenes"][0]["variations"]) {
      if (each["name"] == name) return each;
    }
    return {};
  }
};

// Only one pixel of the fake's shows the seed: there is little error, whatever the samples.
TEST_F(BenchErrorTest, WritesTheSameFiguresAsPageTableAndJson) {
  const Outcome outcome = bench({"--frames", "2", "--most-samples", "16"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("out has error.md"));
  EXPECT_EQ(study()["scenes"][0]["frames"], Json({0, 2}));
  const Json plain = variation("8 samples");
  EXPECT_EQ(plain["set"]["render.samples"], "8");
  ASSERT_EQ(plain["frames"].size(), 2u);
  EXPECT_LT(plain["frames"][0]["rmse8"], 10.0);
  EXPECT_GT(plain["frames"][0]["cpu_s"], 0.0);
  EXPECT_THAT(*read_file(folder_ / "out/error.csv"), HasSubstr("gears,\"8 samples\",\"samples\","));
  EXPECT_THAT(*read_file(folder_ / "out/error.md"), HasSubstr("| 8 samples |"));
  for (const char* chart : {"gears_rmse8.svg", "gears_relmse.png", "gears_flip.svg"}) {
    EXPECT_TRUE(exists(std::string("out/") + chart)) << chart;
  }
  EXPECT_FALSE(exists("out/work"));
}

TEST_F(BenchErrorTest, KeepsTheShapeAtAnotherWidth) {
  const Outcome outcome = bench({"--frames", "1", "--most-samples", "16", "--width", "16"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(study()["scenes"][0]["width"], 16);
  EXPECT_EQ(study()["scenes"][0]["height"], 12);
}

// Jobs of one frame: 0 to get warm, 1 and 2 timed, 3 and 4 the reference, then 1 to 16 samples,
// then the rest.
TEST_F(BenchErrorTest, LeavesAVariationOutThatCannotBeRendered) {
  const Outcome outcome =
      bench({"--frames", "1", "--most-samples", "16"}, R"({"fail_frames": [11]})");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const Json first_after = variation("1 sample, oidn_fast");
  EXPECT_THAT(first_after.value("left_out", ""), HasSubstr("will not render"));
  EXPECT_TRUE(first_after["frames"].empty());
  EXPECT_THAT(*read_file(folder_ / "out/error.md"),
              HasSubstr("- fake: will not render: 1 sample, oidn_fast\n"));
  EXPECT_FALSE(variation("1 sample, oidn").contains("left_out"));
}

TEST_F(BenchErrorTest, CannotDoWithoutAReference) {
  const Outcome outcome =
      bench({"--frames", "1", "--most-samples", "16"}, R"({"fail_frames": [5]})");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("the reference of frame 1 was not rendered"));
  EXPECT_FALSE(exists("out/error.md"));
}

TEST_F(BenchErrorTest, LeavesOutWhatTheBudgetHasNoRoomFor) {
  const Outcome outcome =
      bench({"--frames", "1", "--most-samples", "16", "--budget", "15s"}, R"({"delay_s": 0.5})");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_FALSE(variation("1 sample").contains("left_out"));
  EXPECT_THAT(variation("16 samples, path guiding").value("left_out", ""), HasSubstr("budget"));
}

TEST_F(BenchErrorTest, RefusesWhatHasNoPicturesOrTooFewFrames) {
  const Outcome labels = bench({"--set", "labels=geometry"});
  EXPECT_EQ(labels.exit_code, 2);
  EXPECT_THAT(labels.errors, HasSubstr("labels without pictures"));
  const Outcome few = bench({"--frames", "4"});
  EXPECT_EQ(few.exit_code, 2);
  EXPECT_THAT(few.errors, HasSubstr("'gears' has 3 frames, and 4 are to be measured"));
}

TEST_F(BenchErrorTest, RefusesABudgetThatIsNoTime) {
  const Outcome outcome = bench({"--budget", "10 parsecs"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("--budget"));
}

}  // namespace
}  // namespace seedframe
