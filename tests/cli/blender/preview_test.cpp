// seedframe preview with the real Blender.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class RealBlenderPreview : public ProgramTest {};

TEST_F(RealBlenderPreview, ShowsFramesSmallAndNeitherNoiseNorACampaignStays) {
  write("gears.yaml",
        "seedframe: 1\nname: gears\nscenes: 20\ncategories: [gear]\n"
        "render: {width: 480, height: 360, samples: 12}\nobjects: {o: {asset: gear}}\n"
        "ground: {material: Concrete01}\nlights: {l: {type: sun, power: 3, position: [1, 1, 2]}}\n"
        "camera: {distance_m: {uniform: [0.3, 0.5]}}\n");
  const Outcome outcome = run({"preview", "gears.yaml", "--frames", "3"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("3 of 20 frames, rendered with 8 samples"));
  EXPECT_THAT(outcome.output, HasSubstr("All 20 frames: about "));
  EXPECT_THAT(outcome.output, HasSubstr(" s a frame)"));
  EXPECT_TRUE(exists("gears-preview.png"));
  EXPECT_FALSE(exists("results"));
}

}  // namespace
}  // namespace seedframe
