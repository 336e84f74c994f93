#include "image/color_trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class ColorTrial : public ::testing::Test {
 protected:
  Status try_spaces(const std::string& spaces) {
    const std::string text = R"(ocio_profile_version: 2
search_path: .
roles: {scene_linear: linear, default: linear}
displays:
  screen:
    - !<View> {name: Plain, colorspace: seen}
colorspaces:
  - !<ColorSpace>
    name: linear
)" + spaces;
    EXPECT_TRUE(write_file(folder_ / "config.ocio", text));
    return try_color_config(folder_ / "config.ocio", {"screen", "Plain", ""},
                            std::chrono::seconds(5));
  }
  const ScratchFolder folder_;
};

TEST_F(ColorTrial, AConfigThatWorksPasses) {
  EXPECT_TRUE(try_spaces("  - !<ColorSpace>\n    name: seen\n"));
}

TEST_F(ColorTrial, WhatOpenColorIoSaysComesBack) {
  const Status tried = try_spaces("  - !<ColorSpace>\n    name: other\n");
  ASSERT_FALSE(tried);
  EXPECT_EQ(tried.error().kind, ErrorKind::kInput);
  EXPECT_THAT(tried.error().message, HasSubstr("config.ocio"));
  EXPECT_THAT(tried.error().message, HasSubstr("seen"));
}

TEST_F(ColorTrial, SpacesThatLeadToEachOtherEndTheTrialAndNotUs) {
  const Status tried = try_spaces(R"(  - !<ColorSpace>
    name: seen
    from_reference: !<ColorSpaceTransform> {src: linear, dst: other}
  - !<ColorSpace>
    name: other
    from_reference: !<ColorSpaceTransform> {src: linear, dst: seen}
)");
  ASSERT_FALSE(tried);
  EXPECT_EQ(tried.error().kind, ErrorKind::kInput);
  EXPECT_THAT(tried.error().message, HasSubstr("config.ocio"));
}

TEST_F(ColorTrial, OneThatDoesNotComeToAnEndIsGivenUp) {
  EXPECT_TRUE(try_spaces("  - !<ColorSpace>\n    name: seen\n"));
  const Status tried = try_color_config(folder_ / "config.ocio", {}, std::chrono::seconds(0));
  ASSERT_FALSE(tried);
  EXPECT_EQ(tried.error().kind, ErrorKind::kInput);
  EXPECT_THAT(tried.error().message, HasSubstr("did not come to an end within 0 s"));
}

}  // namespace
}  // namespace seedframe
