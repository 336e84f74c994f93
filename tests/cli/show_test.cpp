// Pictures of campaigns: whole, failed, damaged, moved, and with strange names.

#include <gmock/gmock.h>

#include "image/png_file.h"
#include "store/job_store.h"
#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

class ShowTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("gears.yaml",
                 "seedframe: 1\nname: gears\nscenes: 3\nframes_per_scene: 2\n"
                 "categories: [gear, 'Größe <b>']\n"
                 "labels: {check: false}\nrender: {width: 64, height: 48, passes: [depth]}\n"
                 "objects: {a: {asset: gear}, b: {asset: hex_bolt, category: 'Größe <b>'}}\n"
                 "camera: {distance_m: {uniform: [0.3, 0.5]}}\n");
  }
  Outcome render(const std::string& faults = "{}") {
    return run({"submit", "gears.yaml", "-o", "c", "--quiet", "--blender", kFakeBlender},
               {"SEEDFRAME_FAKE=" + faults});
  }
  Outcome label() {
    return run({"submit", "gears.yaml", "-o", "c", "--quiet", "--set", "labels=geometry"});
  }
  Outcome show(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "show");
    return run(arguments);
  }
  Image<std::uint8_t> picture(const std::string& name) {
    auto read = read_png8(folder_ / name);
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : Image<std::uint8_t>();
  }
};

TEST_F(ShowTest, OfACampaignIsASheetAndOfAFrameItsPanels) {
  ASSERT_EQ(render().exit_code, 0);
  const Outcome sheet = show({"c"});
  ASSERT_EQ(sheet.exit_code, 0) << sheet.errors;
  EXPECT_THAT(sheet.output, HasSubstr("c.png: 6 frames, image+boxes+names ("));
  EXPECT_GT(picture("c.png").width, 3 * 192);
  const Outcome frame = show({"c", "4"});
  ASSERT_EQ(frame.exit_code, 0) << frame.errors;
  EXPECT_THAT(frame.output, HasSubstr("c-frame-4.png: frame 4, image, image+boxes+names"));
  EXPECT_THAT(frame.output, HasSubstr("depth"));
}

TEST_F(ShowTest, TakesFramesLayersAndAShape) {
  ASSERT_EQ(render().exit_code, 0);
  const Outcome outcome = show({"c", "all", "--sheet", "3", "--layers", "image,instances",
                                "--plain", "--tile-width", "64", "-o", "sheet.png"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(picture("sheet.png").width, 3 * 64 + 2 * 6);
  EXPECT_EQ(picture("sheet.png").height, 4 * 48 + 3 * 6);
  ASSERT_EQ(show({"c", "--sheet", "2x2", "--layers", "image,depth", "-o", "two.png"}).exit_code, 0);
  EXPECT_THAT(show({"c", "1-3", "5", "-o", "four.jpg"}).output, HasSubstr("four.jpg: 4 frames"));
}

TEST_F(ShowTest, IsTheSameBytesAgain) {
  ASSERT_EQ(label().exit_code, 0);
  ASSERT_EQ(show({"c", "-o", "a.png"}).exit_code, 0);
  ASSERT_EQ(show({"c", "-o", "b.png"}).exit_code, 0);
  EXPECT_EQ(*read_file(folder_ / "a.png"), *read_file(folder_ / "b.png"));
}

TEST_F(ShowTest, OfLabelsAloneShowsThem) {
  ASSERT_EQ(label().exit_code, 0);
  const Outcome sheet = show({"c"});
  EXPECT_EQ(sheet.exit_code, 0) << sheet.errors;
  EXPECT_THAT(sheet.output, HasSubstr("instances+boxes+names"));
  EXPECT_EQ(show({"c", "0", "--layers", "image,disagreement,normals,keypoints"}).exit_code, 0)
      << "why they are not there is on the tiles";
}

TEST_F(ShowTest, WhatFailedOrIsNotThereYetIsATile) {
  EXPECT_EQ(render(R"({"fail_frames": [1, 4], "fail_attempts": 9})").exit_code, 3);
  const Outcome sheet = show({"c"});
  EXPECT_EQ(sheet.exit_code, 0) << sheet.errors;
  EXPECT_THAT(sheet.output, HasSubstr("6 frames"));
  EXPECT_THAT(sheet.errors, HasSubstr("note: frame 1 failed: "));
  EXPECT_THAT(sheet.errors, HasSubstr("note: frame 4 failed: "));
  EXPECT_EQ(show({"c", "4"}).exit_code, 0) << "alone, too";
}

TEST_F(ShowTest, OfACampaignThatHasHardlyBegunShowsWhatThereIs) {
  ASSERT_EQ(run({"submit", "gears.yaml", "-o", "c", "--quiet", "--set", "labels=geometry",
                 "--frames", "2"})
                .exit_code,
            0);
  EXPECT_THAT(show({"c"}).output, HasSubstr("c.png: 2 frames"));
  EXPECT_EQ(show({"c", "5"}).exit_code, 0) << "a tile says that it is not there yet";
}

TEST_F(ShowTest, OfACampaignThatCameToNothingSaysWhy) {
  ASSERT_EQ(render(R"({"fail_frames": "all", "fail_attempts": 9})").exit_code, 3);
  const Outcome outcome = show({"c"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("note: frame 5 failed: "));
}

TEST_F(ShowTest, OfAnEmptyCampaignSaysWhatToDo) {
  ASSERT_EQ(label().exit_code, 0);
  {
    auto store = JobStore::open(folder_ / "c/campaign.sqlite");
    ASSERT_TRUE(store);
    ASSERT_TRUE(store->begin_run(0.0, "host", 1));
    for (std::int64_t frame = 0; frame < 6; ++frame) ASSERT_TRUE(store->reset(frame));
  }
  const Outcome outcome = show({"c"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("none of its 6 frames is there yet: 'seedframe resume c'"));
  EXPECT_FALSE(exists("c.png"));
  EXPECT_EQ(show({"no/such/campaign"}).exit_code, 2);
}

TEST_F(ShowTest, ADamagedFrameIsNamedAndTheOthersAreShown) {
  ASSERT_EQ(label().exit_code, 0);
  write("c/frames/000/000002/instances.png", "no longer");
  fs::remove_all(folder_ / "c/frames/000/000003");
  const Outcome outcome = show({"c"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.output, HasSubstr("c.png: 6 frames"));
  EXPECT_THAT(outcome.errors, HasSubstr("frame 2 is damaged: "));
  EXPECT_THAT(outcome.errors, HasSubstr("frame 3 is damaged: "));
  EXPECT_TRUE(exists("c.png"));
}

TEST_F(ShowTest, NeedsNeitherItsConfigNorToWriteIntoTheCampaign) {
  ASSERT_EQ(label().exit_code, 0);
  ASSERT_EQ(show({"c", "-o", "before.png"}).exit_code, 0);
  fs::rename(folder_ / "c", folder_ / "Größe; rm -rf $HOME");
  fs::remove(folder_ / "gears.yaml");
  const fs::path moved = folder_ / "Größe; rm -rf $HOME";
  for (const auto& entry : fs::recursive_directory_iterator(moved)) {
    fs::permissions(entry.path(), fs::perms::owner_write, fs::perm_options::remove);
  }
  const auto before = contents(moved.filename());
  EXPECT_EQ(show({moved.string(), "-o", "after.png"}).exit_code, 0);
  EXPECT_EQ(*read_file(folder_ / "before.png"), *read_file(folder_ / "after.png"));
  EXPECT_EQ(contents(moved.filename()), before);
  EXPECT_THAT(show({moved.string()}).output, HasSubstr("Größe; rm -rf $HOME.png"));
  for (const auto& entry : fs::recursive_directory_iterator(moved)) {
    fs::permissions(entry.path(), fs::perms::owner_write, fs::perm_options::add);
  }
}

TEST_F(ShowTest, RefusesWhatItCannotShow) {
  ASSERT_EQ(label().exit_code, 0);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"c", "--layers", "boxs"}, "did you mean 'boxes'?"},
      {{"c", "6"}, "there is no frame 6: the campaign has frames 0 to 5"},
      {{"c", "0-99"}, "there is no frame 99"},
      {{"c", "x"}, "'x' is no frame"},
      {{"c", "3-1"}, "'3-1' is no frame"},
      {{"c", "1-"}, "'1-' is no frame"},
      {{"c", "--sheet", "6y4"}, "such as 6x4"},
      {{"c", "--sheet", "0x4"}, "such as 6x4"},
      {{"c", "--sheet", "3x3", "--layers", "boxes,depth"}, "a multiple of 2"},
      {{"c", "--tile-width", "8192"}, "show fewer frames, or smaller ones (--tile-width)"},
      {{"c", "-o", "c.bmp"}, ".png or .jpg"},
      {{"c", "-o", "gears.yaml"}, ".png or .jpg"}};
  for (const auto& [arguments, words] : cases) {
    const Outcome outcome = show(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << words;
    EXPECT_THAT(outcome.errors, HasSubstr(words));
  }
  EXPECT_FALSE(exists("c.png"));
}

TEST_F(ShowTest, ReplacesItsOwnPicturesOnly) {
  ASSERT_EQ(label().exit_code, 0);
  write("c.png", "a picture of my cat");
  const Outcome refused = show({"c"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("--overwrite"));
  EXPECT_EQ(*read_file(folder_ / "c.png"), "a picture of my cat");
  EXPECT_EQ(show({"c", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(show({"c"}).exit_code, 0);
}

TEST_F(ShowTest, SaysWhereThePictureIsWhenThereIsNoScreen) {
  ASSERT_EQ(label().exit_code, 0);
  const Outcome outcome = run({"show", "c", "--open"}, {"DISPLAY=", "WAYLAND_DISPLAY="});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.errors, HasSubstr("there is no screen here"));
  EXPECT_THAT(outcome.errors, HasSubstr("open c.png yourself"));
}

}  // namespace
}  // namespace seedframe
