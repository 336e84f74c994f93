// seedframe render and seedframe verify-error: beside a campaign, which stays as it is.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class BesideTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("gears.yaml", R"(seedframe: 1
name: gears
scenes: 4
categories: [gear]
render: {width: 32, height: 24, samples: 4}
labels: {check: false}
objects: {gears: {asset: gear, position: [{uniform: [-0.1, 0.1]}, 0, 0]}}
camera: {position: [0, 0, 0.4], target: [0, 0, 0]}
)");
    const Outcome outcome = with_fake({"submit", "gears.yaml", "-o", "c", "--quiet"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    before_ = contents("c");
  }
  void TearDown() override { EXPECT_EQ(contents("c"), before_); }

  Outcome with_fake(std::vector<std::string> arguments, const std::string& fake = "{}") {
    arguments.insert(arguments.end(), {"--blender", kFakeBlender});
    return run(arguments, {"SEEDFRAME_FAKE=" + fake});
  }

  std::map<std::string, std::string> before_;
};

TEST_F(BesideTest, RendersAFrameAsTheCampaignHasIt) {
  const Outcome outcome = with_fake({"render", "c", "--frame", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, StartsWith("frame-2.png is frame 2 at 4 samples: "));
  EXPECT_EQ(*read_file(folder_ / "frame-2.png"),
            *read_file(folder_ / "c/frames/000/000002/image.png"));
}

TEST_F(BesideTest, RendersAFrameWithOtherSettings) {
  const Outcome outcome = with_fake({"render", "c", "--frame", "0", "--samples", "64", "--set",
                                     "render.width=64", "-o", "big.exr"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("at 64 samples"));
  EXPECT_TRUE(exists("big.exr"));
}

TEST_F(BesideTest, RefusesFramesAndFilesThatCannotBe) {
  const Outcome frame = with_fake({"render", "c", "--frame", "4"});
  EXPECT_EQ(frame.exit_code, 2);
  EXPECT_THAT(frame.errors, HasSubstr("there is no frame 4: c has frames 0 to 3"));
  const Outcome file = with_fake({"render", "c", "--frame", "0", "-o", "picture.gif"});
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_THAT(file.errors, HasSubstr("picture.gif: expected a name that ends in .png"));
  const Outcome place = with_fake({"render", "c", "--frame", "0", "-o", "nowhere/x.png"});
  EXPECT_EQ(place.exit_code, 4);
  EXPECT_THAT(place.errors, HasSubstr("nowhere/x.png"));
}

TEST_F(BesideTest, SaysWhyAFrameWasNotRendered) {
  const Outcome outcome = with_fake({"render", "c", "--frame", "0"}, R"({"fail_frames": [0]})");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.errors, HasSubstr("frame 0 was not rendered: "));
  EXPECT_FALSE(exists("frame-0.png"));
}

// Only one pixel of the fake's shows the seed: all others are as in the reference.
TEST_F(BesideTest, FindsLittleErrorWhereThereIsLittle) {
  const Outcome outcome =
      with_fake({"verify-error", "c", "--frames", "3", "--max-error", "5", "--quiet"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("3 frames against references of 1024 samples"));
  EXPECT_THAT(outcome.output, HasSubstr("95.0 % were promised: kept"));
}

TEST_F(BesideTest, NamesFramesBeyondAPromise) {
  // Pixels of a reference depend on its number: those of frame 3 (jobs 6 and 7) are brighter.
  const Outcome outcome = with_fake({"verify-error", "c", "--max-error", "5", "--quiet"},
                                    R"({"brighter_frames": [6, 7]})");
  EXPECT_EQ(outcome.exit_code, 10) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("75.0 % of the frames are within rmse8 of 5"));
  EXPECT_THAT(outcome.output, HasSubstr("BROKEN\nbeyond it: 3\n"));
  const Outcome json =
      with_fake({"verify-error", "c", "--frame", "3", "--max-error", "5", "--quiet", "--json"},
                R"({"brighter_frames": [0, 1]})");
  EXPECT_EQ(json.exit_code, 10) << json.errors;
  const auto parsed = parse_json(json.output, "json");
  ASSERT_TRUE(parsed) << json.output;
  EXPECT_EQ((*parsed)["promise"]["beyond"], Json({3}));
  EXPECT_FALSE((*parsed)["promise"]["kept"]);
}

TEST_F(BesideTest, JudgesNothingWithoutAPromise) {
  const Outcome outcome =
      with_fake({"verify-error", "c", "--quiet"}, R"({"brighter_frames": "all"})");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("rmse8: half of them within"));
}

TEST_F(BesideTest, RefusesAFrameThatIsNotThere) {
  const Outcome outcome = with_fake({"verify-error", "c", "--frame", "9"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("frame 9 of c is not done"));
}

}  // namespace
}  // namespace seedframe
