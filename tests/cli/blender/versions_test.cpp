// The Blender that SEEDFRAME_BLENDER names against that of Debian: the main job with both.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/fixtures/real_blender.h"

namespace seedframe {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr const char* kDebians = "blender";
constexpr int kFrames = 4;

class RealBlenderVersions : public ProgramTest {
 protected:
  void SetUp() override {
    if (test_blender() == kDebians) GTEST_SKIP() << "there is no other Blender to compare with";
  }
  Outcome render(const std::string& campaign, const std::string& blender,
                 std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"submit",    SEEDFRAME_HOME "/configs/parts.yaml",
                                          "-o",        campaign,
                                          "--frames",  std::to_string(kFrames),
                                          "--blender", blender,
                                          "--set",     "render.width=320",
                                          "--set",     "render.height=240",
                                          "--set",     "render.samples=2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  Json made_with(const std::string& campaign) const {
    return parse_json(*read_file(folder_ / campaign / "provenance.json"), campaign)
        ->at("attempts")
        .at(0);
  }
};

TEST_F(RealBlenderVersions, TheDemosLabelsAreByteForByteThoseOfDebiansBlender) {
  const Outcome debians = render("debians", kDebians);
  ASSERT_EQ(debians.exit_code, 0) << debians.errors;
  const Outcome others = render("others", test_blender());
  ASSERT_EQ(others.exit_code, 0) << others.errors;
  EXPECT_EQ(others.errors.find("not a version"), std::string::npos) << others.errors;

  const auto expected = contents("debians/frames");
  const auto found = contents("others/frames");
  int labels = 0, other_pictures = 0;
  for (const auto& [name, bytes] : expected) {
    ASSERT_EQ(found.count(name), 1u) << name;
    for (const char* file : {"instances.png", "semantic.png", "labels.json", "frame.json"}) {
      if (!name.ends_with(file)) continue;
      EXPECT_TRUE(found.at(name) == bytes) << name;
      ++labels;
    }
    if (name.ends_with("image.png") && found.at(name) != bytes) ++other_pictures;
  }
  EXPECT_EQ(labels, 4 * kFrames);
  EXPECT_EQ(other_pictures, kFrames) << "or it was the same Blender";
  const Json twin = status("others").at("twin");
  EXPECT_EQ(twin.at("frames"), kFrames);
  EXPECT_EQ(twin.at("inside_px"), 0);

  const Json made = made_with("others");
  EXPECT_NE(made.at("blender"), made_with("debians").at("blender"));
  EXPECT_EQ(made.at("blender_sha256").get<std::string>().size(), 64u);
  EXPECT_THAT(made.at("kernel").get<std::string>(), AnyOf("avx2", "avx", "sse42", "sse41"));
  EXPECT_NE(made.at("embree"), "") << "it cannot be told";
}

TEST_F(RealBlenderVersions, KernelsArePinnedAndAnAuditFindsTheSamePixels) {
  const Outcome made = render("c", test_blender(), {"--set", "determinism.mode=portable"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_EQ(made_with("c").at("kernel"), "avx2");
  EXPECT_EQ(made_with("c").at("embree"), "avx2");
  const Outcome audited =
      run({"audit", "c", "--frames", "3", "--blender", test_blender(), "--quiet"});
  EXPECT_EQ(audited.exit_code, 0) << audited.output << audited.errors;
  EXPECT_THAT(audited.output, HasSubstr("identical"));
}

TEST_F(RealBlenderVersions, DoctorTellsWhatItCan) {
  const Outcome outcome = run({"doctor", "--blender", test_blender()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("on CPU ("));
  EXPECT_THAT(outcome.output, HasSubstr("denoisers: OpenImageDenoise"));
  EXPECT_THAT(outcome.output, HasSubstr("datafiles/colormanagement/config.ocio"));
}

}  // namespace
}  // namespace seedframe
