// A campaign that needs what a worker may lack: a device, a denoiser.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class AbilitiesTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("abilities.yaml", R"(seedframe: 1
name: abilities
scenes: 3
categories: [gear]
render: {width: 32, height: 24, samples: 1}
objects:
  gears: {asset: gear}
camera: {distance_m: 0.3}
labels: {check: false}
)");
  }
  Outcome submit(const std::string& setting, const std::string& fake) {
    return run({"submit", "abilities.yaml", "-o", "c", "--blender", kFakeBlender, "--set", setting},
               {"SEEDFRAME_FAKE=" + fake});
  }
  Outcome resume(const std::string& fake) {
    return run({"resume", "c", "--blender", kFakeBlender}, {"SEEDFRAME_FAKE=" + fake});
  }
};

TEST_F(AbilitiesTest, ADeviceIsUsedAndNamedOrTheRunEndsWithThoseThatThereAre) {
  const Outcome none = submit("render.device=cuda", R"J({"devices": ["HIP (fake card)"]})J");
  EXPECT_EQ(none.exit_code, 4) << none.errors;
  EXPECT_THAT(none.errors, HasSubstr("render.device is cuda"));
  EXPECT_THAT(none.errors, HasSubstr("only CPU (fake), HIP (fake card)"));
  EXPECT_EQ(status("c").at("pending"), 3);

  const Outcome two = resume(R"J({"devices": ["HIP (fake card)", "CUDA (one)", "CUDA (two)"]})J");
  EXPECT_EQ(two.exit_code, 0) << two.errors;
  const Json explained = Json::parse(run({"explain", "c", "0", "--json"}).output);
  EXPECT_EQ(explained.at("attempts").back().at("provenance").at("device"),
            "CUDA (one), CUDA (two)");
}

TEST_F(AbilitiesTest, AMissingDenoiserEndsTheRunBeforeAnyFrame) {
  const Outcome none = submit("render.denoise=oidn", "{}");
  EXPECT_EQ(none.exit_code, 4) << none.errors;
  EXPECT_THAT(none.errors, HasSubstr("render.denoise needs Open Image Denoise"));
  EXPECT_EQ(status("c").at("pending"), 3);
  EXPECT_EQ(resume(R"({"denoisers": "OpenImageDenoise"})").exit_code, 0);
}

}  // namespace
}  // namespace seedframe
