// A look at a config before it is rendered: by its twin, and by a Blender.

#include <gmock/gmock.h>

#include "image/png_file.h"
#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

class PreviewTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("gears.yaml",
                 "seedframe: 1\nname: gears\nscenes: 40\ncategories: [gear]\n"
                 "render: {width: 640, height: 480, samples: 64}\n"
                 "objects: {o: {asset: gear}}\ncamera: {distance_m: {uniform: [0.3, 0.6]}}\n");
  }
  Outcome preview(const std::vector<std::string>& more, const std::string& faults = "{}") {
    std::vector<std::string> arguments = {"preview", "gears.yaml", "--blender", kFakeBlender};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, {"SEEDFRAME_FAKE=" + faults});
  }
};

TEST_F(PreviewTest, ByTheTwinNeedsNoBlender) {
  const Outcome outcome =
      run({"preview", "gears.yaml", "--labels-only", "--blender", "/no/blender"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output,
              HasSubstr("gears-preview.png: 8 of 40 frames, shaded by the twin, not rendered"));
  EXPECT_THAT(outcome.output, HasSubstr("longer side of boxes, px"));
  EXPECT_THAT(outcome.output, HasSubstr("All 40 frames: about "));
  EXPECT_GT(read_png8(folder_ / "gears-preview.png")->width, 4 * 320);
}

TEST_F(PreviewTest, ByTheTwinIsTheSameBytesAgain) {
  ASSERT_EQ(preview({"--labels-only", "-o", "a.jpg", "--frames", "3"}).exit_code, 0);
  ASSERT_EQ(preview({"--labels-only", "-o", "b.jpg", "--frames", "3"}).exit_code, 0);
  EXPECT_EQ(*read_file(folder_ / "a.jpg"), *read_file(folder_ / "b.jpg"));
}

TEST_F(PreviewTest, OfLabelsAloneIsByTheTwin) {
  const Outcome outcome = run({"preview", "gears.yaml", "--set", "labels=geometry", "--frames", "1",
                               "--blender", "/no/blender"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("1 of 40 frames, shaded"));
  EXPECT_THAT(outcome.output, HasSubstr("--dry-run --pilot 8' tells the time"));
}

TEST_F(PreviewTest, ByBlenderIsSmallAndTellsTimeAndDisk) {
  const Outcome outcome = preview({"--frames", "4"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("4 of 40 frames, rendered with 8 samples, denoised"));
  EXPECT_THAT(outcome.output, HasSubstr("All 40 frames: about "));
  EXPECT_THAT(outcome.output, HasSubstr(" s a frame) and "));
  EXPECT_THAT(outcome.output, HasSubstr("MB on the disk"));
  EXPECT_GT(read_png8(folder_ / "gears-preview.png")->width, 2 * 320);
  EXPECT_FALSE(exists("results")) << "nothing else is written";
}

TEST_F(PreviewTest, WithoutADenoiserIsNoisy) {
  for (const char* frames : {"1", "6"}) {
    const Outcome outcome = preview({"--frames", frames}, R"({"no_denoiser": true})");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr(std::string(frames) + " of 40 frames, rendered with 8"));
    EXPECT_THAT(outcome.output, Not(HasSubstr("denoised")));
    EXPECT_THAT(outcome.output, HasSubstr(" s a frame)"));
  }
}

TEST_F(PreviewTest, FramesThatFailAreNamedAndTheOthersShown) {
  const Outcome some = preview({"--frames", "4"}, R"({"fail_frames": [1]})");
  EXPECT_EQ(some.exit_code, 3);
  EXPECT_THAT(some.output, HasSubstr("3 of 40 frames"));
  EXPECT_THAT(some.errors, HasSubstr("failed: "));
  const Outcome none =
      preview({"--frames", "2", "-o", "none.png"}, R"({"fail_frames": "all", "fail_attempts": 9})");
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.errors, HasSubstr("no frame could be rendered"));
  EXPECT_FALSE(exists("none.png"));
}

TEST_F(PreviewTest, WarnsOfWhatIsHardlyMeant) {
  const Outcome outcome =
      preview({"--labels-only", "--set", "camera.target=[50, 0, 0]", "--set", "scenes=2"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("warning: nothing that has a category is seen"));
  EXPECT_THAT(outcome.output, HasSubstr("none"));
}

TEST_F(PreviewTest, WithAPromisedErrorTellsNoTime) {
  const Outcome outcome =
      preview({"--frames", "1", "--set", "quality={metric: rmse8, max_error: 4}"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("with 'quality' samples are chosen"));
}

TEST_F(PreviewTest, SaysWhatIsWrong) {
  EXPECT_EQ(run({"preview", "no.yaml"}).exit_code, 2);
  EXPECT_EQ(preview({"--set", "camera.distance_m=-1", "--labels-only"}).exit_code, 2);
  EXPECT_THAT(preview({"-o", "p.gif"}).errors, HasSubstr(".png or .jpg"));
  write("gears-preview.png", "somebody's");
  EXPECT_THAT(preview({"--labels-only"}).errors, HasSubstr("--overwrite"));
  const Outcome no_blender =
      run({"preview", "gears.yaml", "--blender", "/no/blender", "-o", "x.png"});
  EXPECT_EQ(no_blender.exit_code, 4);
  EXPECT_FALSE(exists("x.png"));
}

}  // namespace
}  // namespace seedframe
