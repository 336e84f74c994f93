// Faces of two objects at one place: which of them a pixel shows is rounding's choice, in Blender
// as in the twin, and no frame is refused for it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/fixtures/real_blender.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class RealBlenderTwinTies : public ProgramTest {
 protected:
  Outcome submit(const std::string& objects) {
    write("scene.yaml",
          "seedframe: 1\nscenes: 3\ncategories: [cube]\n"
          "render: {width: 160, height: 120, samples: 1}\nground: {width_m: 2, depth_m: 2}\n"
          "objects:\n" +
              objects +
              "lights: {sun: {type: sun, position: [0.5, -1, 1], power: 3}}\n"
              "camera: {target: [0, 0, 0], distance_m: 0.7, elevation_deg: 20, "
              "azimuth_deg: {uniform: [-30, 30]}}\n");
    return run({"submit", "scene.yaml", "-o", "c", "--quiet", "--blender", test_blender()});
  }
};

TEST_F(RealBlenderTwinTies, AStickerOnABoxIsRendered) {
  const Outcome outcome = submit(
      "  large: {asset: cube, category: cube, scale: 4, position: [0, 0, 0.1]}\n"
      "  small: {asset: cube, category: cube, scale: 2, position: [0, -0.05, 0.1]}\n");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
}

TEST_F(RealBlenderTwinTies, ATableTopInTheGroundsPlaneIsSeenWhole) {
  const Outcome outcome =
      submit("  top: {asset: cube, category: cube, scale: [4, 4, 1], position: [0, 0, -0.025]}\n");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  for (int frame = 0; frame < 3; ++frame) {
    const Outcome explained = run({"explain", "c", std::to_string(frame), "--json"});
    const Json object = Json::parse(explained.output).at("objects").at(0);
    EXPECT_GT(object.at("visible_px").get<int>(), 750) << "half of it, if the ground showed too";
    EXPECT_EQ(object.at("asset"), "cube");
  }
  EXPECT_THAT(run({"explain", "c", "0"}).output, HasSubstr("top/0"));
}

}  // namespace
}  // namespace seedframe
