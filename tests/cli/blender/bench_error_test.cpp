// seedframe bench error with the real Blender, small: noise falls as it must, and its references
// know their own.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

class RealBlenderError : public ProgramTest {
 protected:
  void SetUp() override {
    write("gears.yaml", R"(seedframe: 1
name: gears
scenes: 2
categories: [gear]
render: {width: 64, height: 48, samples: 4, max_bounces: 4}
objects: {gears: {asset: gear, count: 3, scatter: {x: [-0.12, 0.12], y: [-0.12, 0.12]}, rest_on_ground: true, material: zinc}}
ground: {width_m: 1, depth_m: 1, material: plastic}
lights: {key: {type: area, position: [0.3, -0.3, 0.6], power: 4, width_m: 0.3, height_m: 0.3}}
camera: {position: [0, -0.2, 0.3], target: [0, 0, 0]}
)");
    const Outcome outcome = run({"bench", "error", "gears.yaml", "-o", "out", "--frames", "2",
                                 "--most-samples", "64", "--reference-samples", "512"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    study_ = *parse_json(read_file(folder_ / "out/error.json").value(), "error.json");
  }

  Json variation(const std::string& name) const {
    for (const Json& each : study_["scenes"][0]["variations"]) {
      if (each["name"] == name) return each;
    }
    return {};
  }

  double mean(const std::string& variation_name, const char* measure) const {
    const Json found = variation(variation_name);
    double sum = 0.0;
    for (const Json& frame : found["frames"]) sum += frame[measure].get<double>();
    return sum / static_cast<double>(found["frames"].size());
  }

  Json study_;
};

TEST_F(RealBlenderError, FallsWithTheRootOfTheSamples) {
  // The clamp of a config is part of what is measured; here it does nothing.
  const double at_4 = mean("4 samples", "rmse");
  const double at_64 = mean("64 samples", "rmse");
  EXPECT_GT(at_4 / at_64, 2.5);  // 4 but for chance and for samples that are better than chance
  EXPECT_LT(at_4 / at_64, 9.0);
  EXPECT_GT(mean("64 samples", "cpu_s"), mean("4 samples", "cpu_s"));
  EXPECT_GT(mean("4 samples", "flip"), mean("64 samples", "flip"));
  EXPECT_GT(mean("64 samples", "ssim"), mean("4 samples", "ssim"));

  // Levers that this scene has no use for change nothing but the time.
  EXPECT_NEAR(mean("16 samples, transmission bounces 0", "rmse8"), mean("16 samples", "rmse8"),
              1e-9);
  // Every variation was measured, or says why not.
  for (const Json& each : study_["scenes"][0]["variations"]) {
    EXPECT_NE(each["frames"].empty(), each.value("left_out", "").empty()) << each["name"];
  }
}

}  // namespace
}  // namespace seedframe
