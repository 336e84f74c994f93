#include "image/color_management.h"

#include <atomic>
#include <limits>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "base/sha256.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// Two views that arithmetic can follow, and a look that halves.
constexpr const char* kConfig = R"(ocio_profile_version: 1
roles:
  scene_linear: linear
  default: linear
displays:
  screen:
    - !<View> {name: Plain, colorspace: linear}
    - !<View> {name: Root, colorspace: root}
active_displays: [screen]
active_views: [Plain, Root]
looks:
  - !<Look>
    name: Half
    process_space: linear
    transform: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
colorspaces:
  - !<ColorSpace>
    name: linear
    bitdepth: 32f
    isdata: false
  - !<ColorSpace>
    name: root
    bitdepth: 32f
    isdata: false
    from_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
)";

class ColorManagementTest : public testing::Test {
 protected:
  ColorManagement load() {
    EXPECT_TRUE(write_file(folder_ / "config.ocio", kConfig));
    auto loaded = ColorManagement::load(folder_ / "config.ocio");
    if (!loaded) throw std::runtime_error(loaded.error().message);
    return std::move(*loaded);
  }

  ScratchFolder folder_;
};

Image<float> pixel(float red, float green, float blue) {
  Image<float> image(1, 1, 4);
  image.values = {red, green, blue, 1.0F};
  return image;
}

TEST_F(ColorManagementTest, RoundsToTheNearestCodeValueAndClamps) {
  const ColorManagement colors = load();
  const ImageSettings plain{"screen", "Plain", "None"};
  EXPECT_THAT(colors.apply(pixel(0.0F, 0.5F, 1.0F), plain)->values, ElementsAre(0, 128, 255));
  EXPECT_THAT(colors.apply(pixel(-3.0F, 20.0F, 1e10F), plain)->values, ElementsAre(0, 255, 255));
  EXPECT_THAT(colors.apply(pixel(99.49F / 255, 99.51F / 255, 0.999F), plain)->values,
              ElementsAre(99, 100, 255));
}

TEST_F(ColorManagementTest, AppliesTheView) {
  const ColorManagement colors = load();
  EXPECT_THAT(colors.apply(pixel(0.25F, 0.01F, 1.0F), {"screen", "Root", ""})->values,
              ElementsAre(128, 26, 255));
}

TEST_F(ColorManagementTest, ExposureComesBeforeTheViewAndGammaAfterIt) {
  const ColorManagement colors = load();
  EXPECT_THAT(colors.apply(pixel(0.25F, 0.0625F, 1.0F), {"screen", "Root", "", -2.0, 1.0})->values,
              ElementsAre(64, 32, 128));
  EXPECT_THAT(colors.apply(pixel(0.0625F, 0.0F, 1.0F), {"screen", "Root", "", 0.0, 2.0})->values,
              ElementsAre(128, 0, 255));
}

TEST_F(ColorManagementTest, TheLookComesAfterTheExposureAndBeforeTheView) {
  const ColorManagement colors = load();
  EXPECT_THAT(colors.apply(pixel(0.25F, 0.5F, 4.0F), {"screen", "Root", "Half", -1.0})->values,
              ElementsAre(64, 90, 255));
}

TEST_F(ColorManagementTest, AlphaDoesNotChangeTheColor) {
  const ColorManagement colors = load();
  Image<float> image = pixel(0.25F, 0.5F, 1.0F);
  image.values[3] = 0.5F;
  EXPECT_THAT(colors.apply(image, {"screen", "Root", ""})->values, ElementsAre(128, 180, 255));
}

TEST_F(ColorManagementTest, NotANumberIsBlack) {
  const ColorManagement colors = load();
  const auto nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(colors.apply(pixel(nan, 0.5F, 1.0F), {"screen", "Plain", ""})->values[0], 0);
}

TEST_F(ColorManagementTest, KeepsTheOrderOfThePixels) {
  const ColorManagement colors = load();
  Image<float> image(3, 2, 4);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      image.at(row, column, 0) = static_cast<float>(row * 3 + column) / 255.0F;
      image.at(row, column, 2) = 1.0F;
    }
  }
  const auto picture = colors.apply(image, {"screen", "Plain", ""});
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 3);
  EXPECT_EQ(picture->height, 2);
  EXPECT_EQ(picture->channels, 3);
  EXPECT_EQ(picture->at(1, 2, 0), 5);
  EXPECT_EQ(picture->at(1, 2, 1), 0);
  EXPECT_EQ(picture->at(1, 2, 2), 255);
}

TEST_F(ColorManagementTest, UnknownNamesGetDidYouMean) {
  const ColorManagement colors = load();
  const auto message = [&](const ImageSettings& settings) {
    const Status status = colors.check(settings);
    EXPECT_FALSE(status);
    return status ? std::string() : status.error().message;
  };
  EXPECT_THAT(message({"scren", "Plain", ""}),
              AllOf(HasSubstr("no display 'scren'"), HasSubstr("did you mean 'screen'?")));
  EXPECT_THAT(message({"screen", "Rot", ""}),
              AllOf(HasSubstr("no view 'Rot'"), HasSubstr("did you mean 'Root'?")));
  EXPECT_THAT(message({"screen", "Plain", "Halv"}),
              AllOf(HasSubstr("no look 'Halv'"), HasSubstr("did you mean 'Half'?")));
  EXPECT_THAT(message({"screen", "Filmic", ""}), HasSubstr("there are: Plain, Root"));
}

TEST_F(ColorManagementTest, ApplyChecksTheNamesToo) {
  const ColorManagement colors = load();
  const auto picture = colors.apply(pixel(0, 0, 0), {"screen", "Rot", ""});
  ASSERT_FALSE(picture);
  EXPECT_EQ(picture.error().kind, ErrorKind::kInput);
}

TEST_F(ColorManagementTest, ExposureAndGammaMustBeUsableNumbers) {
  const ColorManagement colors = load();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(colors.check({"screen", "Plain", "", infinity, 1.0}));
  EXPECT_FALSE(colors.check({"screen", "Plain", "", 0.0, 0.0}));
  EXPECT_FALSE(colors.check({"screen", "Plain", "", 0.0, -1.0}));
  EXPECT_TRUE(colors.check({"screen", "Plain", "None", -3.0, 2.2}));
}

TEST_F(ColorManagementTest, TheHashIsThatOfTheConfigFile) {
  EXPECT_EQ(load().config_hash(), sha256_hex(kConfig));
}

TEST_F(ColorManagementTest, AMissingConfigAndGarbageAreInputErrors) {
  const auto missing = ColorManagement::load(folder_ / "none.ocio");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::kInput);
  EXPECT_THAT(missing.error().message, HasSubstr("none.ocio"));
  for (const char* text : {"", "hello", "ocio_profile_version: 1\n", "{[", "a: b\n"}) {
    ASSERT_TRUE(write_file(folder_ / "bad.ocio", text));
    const auto bad = ColorManagement::load(folder_ / "bad.ocio");
    ASSERT_FALSE(bad) << text;
    EXPECT_EQ(bad.error().kind, ErrorKind::kInput);
    EXPECT_THAT(bad.error().message, HasSubstr("bad.ocio"));
  }
}

TEST_F(ColorManagementTest, TablesLieInTheFolderOfTheConfig) {
  EXPECT_TRUE(write_file(folder_ / "table.spi1d", "Version 1\n"));
  EXPECT_TRUE(make_folders(folder_ / "sub/luts"));
  const auto error_of = [&](const std::string& search_path, const std::string& transform) {
    const std::string text = std::string(kConfig) + "    to_reference: " + transform + "\n";
    EXPECT_TRUE(
        write_file(folder_ / "sub/config.ocio", "search_path: " + search_path + "\n" + text));
    const auto loaded = ColorManagement::load(folder_ / "sub/config.ocio");
    return loaded ? std::string() : loaded.error().message;
  };
  const std::string file = "!<FileTransform> {src: table.spi1d}";
  const std::string outside = "outside of the folders that may be read";
  EXPECT_THAT(error_of("..", file), HasSubstr(outside));
  EXPECT_THAT(error_of((folder_ / "sub/..").string(), file), HasSubstr(outside));
  EXPECT_THAT(error_of("luts", "!<FileTransform> {src: ../../table.spi1d}"), HasSubstr(outside));
  EXPECT_THAT(error_of("luts", "!<FileTransform> {src: /dev/zero}"), HasSubstr(outside));
  EXPECT_THAT(error_of("..", "!<GroupTransform> {children: [" + file + "]}"), HasSubstr(outside));
  std::filesystem::create_symlink("../../table.spi1d", folder_ / "sub/luts/link.spi1d");
  EXPECT_THAT(error_of("luts", "!<FileTransform> {src: link.spi1d}"), HasSubstr(outside));
  EXPECT_TRUE(write_file(folder_ / "sub/luts/table.spi1d", "Version 1\n"));
  EXPECT_EQ(error_of("luts", file), "");

  const auto refer_to = [&](const std::string& table, const std::string& other) {
    EXPECT_TRUE(write_file(folder_ / "sub/luts" / table,
                           "\n<?xml version='1.0'?><ProcessList id='a' version='2'>"
                           "<Reference path='" +
                               other + "'/></ProcessList>"));
  };
  refer_to("a.ctf", "b.ctf");
  refer_to("b.ctf", "../../table.spi1d");
  EXPECT_THAT(error_of("luts", "!<FileTransform> {src: a.ctf}"), HasSubstr(outside));
  refer_to("b.ctf", "/dev/zero");
  EXPECT_THAT(error_of("luts", "!<FileTransform> {src: a.ctf}"), HasSubstr(outside));
  refer_to("b.ctf", "a.ctf");
  EXPECT_THAT(error_of("luts", "!<FileTransform> {src: a.ctf}"), HasSubstr("refers to itself"));
  refer_to("b.ctf", "table.spi1d");
  EXPECT_EQ(error_of("luts", "!<FileTransform> {src: a.ctf}"), "");
}

TEST_F(ColorManagementTest, ThreadsShareIt) {
  const ColorManagement colors = load();
  Image<float> image(64, 64, 4);
  std::fill(image.values.begin(), image.values.end(), 0.25F);
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (int i = 0; i < 20; ++i) {
        const char* view = (thread + i) % 2 == 0 ? "Plain" : "Root";
        const double stops = i % 3, gamma = 1.0 + 0.5 * (i % 2);
        ASSERT_TRUE(colors.apply(image, {"screen", view, "Half", stops, gamma}));
        const auto picture = colors.apply(image, {"screen", view, ""});
        const int expected = (thread + i) % 2 == 0 ? 64 : 128;
        if (!picture || picture->at(63, 63, 2) != expected) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

// A level that no OpenColorIO has: one view can be made of it, the others hang on a transform that
// nobody has built in.
constexpr const char* kOfTheFuture = R"(ocio_profile_version: 9.9
roles: {scene_linear: linear, default: linear}
displays:
  screen:
    - !<View> {name: Plain, colorspace: linear}
    - !<View> {name: Root, colorspace: root}
    - !<View> {name: New, colorspace: of tomorrow}
    - !<View> {name: Made of it, colorspace: behind}
  wall:
    - !<View> {name: Plain, colorspace: of tomorrow}
active_displays: [screen, wall]
active_views: [Plain, Root, New, Made of it]
looks:
  - !<Look>
    name: New look
    process_space: tomorrow
    transform: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
colorspaces:
  - !<ColorSpace>
    name: linear
    bitdepth: 32f
    description: |
      Two lines: of text,
      # and no comment
  - !<ColorSpace>
    name: behind
    from_reference: !<GroupTransform>
      children:
        - !<ColorSpaceTransform> {src: linear, dst: tomorrow}
        - !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
  - !<ColorSpace>
    name: of tomorrow
    aliases: [tomorrow]
    from_reference: !<GroupTransform>
      children:
        - !<BuiltinTransform> {style: "NOBODY - HAS_THIS"}
  - !<ColorSpace>
    name: root
    from_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
)";

TEST_F(ColorManagementTest, OfAConfigOfALaterLevelWhatTheLibraryHasMeansTheSame) {
  const ColorManagement now = load();
  ASSERT_TRUE(write_file(folder_ / "later.ocio", kOfTheFuture));
  const auto later = ColorManagement::load(folder_ / "later.ocio");
  ASSERT_TRUE(later) << later.error().message;
  EXPECT_EQ(later->config_hash(), sha256_hex(kOfTheFuture));
  Image<float> linear(3, 1, 4);
  linear.values = {0.25F, 0.5F, 0.75F, 1.0F, 0.01F, 2.0F, 0.9F, 1.0F, 0.0F, 1.0F, 0.1F, 1.0F};
  for (const char* view : {"Plain", "Root"}) {
    const ImageSettings settings{"screen", view, "None", 0.0, 1.0};
    EXPECT_EQ(later->apply(linear, settings)->values, now.apply(linear, settings)->values) << view;
  }
}

TEST_F(ColorManagementTest, WhatNeedsALaterLibraryIsNamedWhenItIsAskedFor) {
  ASSERT_TRUE(write_file(folder_ / "later.ocio", kOfTheFuture));
  const auto later = ColorManagement::load(folder_ / "later.ocio");
  ASSERT_TRUE(later);
  for (const char* view : {"New", "Made of it"}) {
    const Status checked = later->check({"screen", view, "None", 0.0, 1.0});
    ASSERT_FALSE(checked) << view;
    EXPECT_THAT(checked.error().message, HasSubstr("needs a later OpenColorIO")) << view;
  }
  EXPECT_FALSE(later->check({"wall", "Plain", "None", 0.0, 1.0}));
  EXPECT_THAT(later->check({"screen", "Plain", "New look", 0.0, 1.0}).error().message,
              HasSubstr("no look 'New look'"));
}

TEST_F(ColorManagementTest, AConfigOfALaterLevelThatIsNoConfigIsRefused) {
  for (const char* text : {"ocio_profile_version: 9.9\n[", "ocio_profile_version: 9.9\ndisplays: 3",
                           "ocio_profile_version: 9.9\ndisplays: {screen: [{}]}",
                           "ocio_profile_version: 9.9\ncolorspaces: [3]"}) {
    ASSERT_TRUE(write_file(folder_ / "bad.ocio", text));
    const auto bad = ColorManagement::load(folder_ / "bad.ocio");
    ASSERT_FALSE(bad) << text;
    EXPECT_EQ(bad.error().kind, ErrorKind::kInput);
  }
}

}  // namespace
}  // namespace seedframe
