#include "formats/patches.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/split.h"
#include "export/verify.h"
#include "image/crop.h"
#include "image/png_file.h"
#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

/// ImageFolder refuses a class without an image, and numbers the others by the folders there are.
TEST(ExportPatches, OnlyClassesWithAPatchHaveAFolderAndThatInEverySplit) {
  const ScratchFolder scratch;
  SyntheticDataset campaign(scratch.path() / "campaign");
  IdImage bolt(16, 10);
  bolt.at(2, 2) = 3;
  IdImage both = bolt;
  both.at(5, 5) = 40;
  campaign.dataset().seed = 2;
  ExportOptions options{.output = scratch.path() / "out"};
  options.splits = {{"train", 0.6}, {"val", 0.4}};
  for (const int scene : {0, 1, 2, 3, 4}) {
    const bool trains = split_of_scene(scene, 2, options.splits) == 0;
    campaign.add_frame(scene, scene, trains ? both : bolt);
  }
  const auto summary = export_one(campaign.dataset(), "patches", options);
  ASSERT_TRUE(summary) << summary.error().message;
  const std::set<std::string> shown = {"bolt", "gear"};
  EXPECT_EQ(names_in(summary->folder / "train"), shown);
  EXPECT_EQ(names_in(summary->folder / "val"), shown);
  EXPECT_TRUE(fs::is_empty(summary->folder / "val/gear"));
  EXPECT_THAT(summary->warnings, ElementsAre(HasSubstr("no patch shows 'no', 'say \"über\"'"),
                                             AllOf(HasSubstr("no patch of val shows 'gear'"),
                                                   HasSubstr("allow_empty=True"))));
  const Json classes = *parse_json(*read_file(summary->folder / "classes.json"), "classes");
  EXPECT_EQ(classes.size(), 4U);

  const auto again = export_one(campaign.dataset(), "patches", options);  // all is taken over
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->reused, 5);
  EXPECT_EQ(names_in(again->folder / "val"), shown);
  fs::remove(again->folder / "val/gear");
  EXPECT_THAT(
      verify_export(campaign.dataset(), export_formats(), again->folder, 1)->first_differences,
      ElementsAre("the folder val/gear is missing"));
}

/// Files of an export by the class's folder, all splits together.
std::map<std::string, int> patches_by_class(const fs::path& folder) {
  std::map<std::string, int> counts;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".png") {
      ++counts[entry.path().parent_path().filename().string()];
    }
  }
  return counts;
}

/// Where a piece of an image is in it, by all of its pixels.
std::optional<PixelRect> place_of(const Image<std::uint8_t>& piece,
                                  const Image<std::uint8_t>& image) {
  for (int y = 0; y + piece.height <= image.height; ++y) {
    for (int x = 0; x + piece.width <= image.width; ++x) {
      const PixelRect rect{x, y, piece.width, piece.height};
      if (cropped(image, rect).values == piece.values) return rect;
    }
  }
  return std::nullopt;
}

/// A floor of gear (40), and bolts (1) and a rock without a class (4) on it.
IdImage floor_with_bolts(int shift) {
  IdImage ids(64, 48);
  for (int row = 8; row < 48; ++row) {
    for (int column = 0; column < 64; ++column) ids.at(row, column) = 40;
  }
  for (int row = 10; row < 17; ++row) {
    for (int column = shift; column < shift + 9; ++column) ids.at(row, column) = 1;
  }
  for (int row = 30; row < 34; ++row) ids.at(row, 60 - shift) = 4;
  return ids;
}

class ExportPatchesPerClass : public ::testing::Test {
 protected:
  ExportPatchesPerClass() : campaign_(scratch_.path() / "campaign") {
    for (int frame = 0; frame < 20; ++frame) {
      campaign_.add_frame(frame, frame / 2, floor_with_bolts(frame));
    }
    options_.output = scratch_.path() / "out";
    options_.patch_classes = {"bolt", "gear"};
    options_.windows = {"gear"};
  }

  const ScratchFolder scratch_;
  SyntheticDataset campaign_;
  ExportOptions options_;
};

TEST_F(ExportPatchesPerClass, ThereAreExactlySoManyOfEveryClassAndSplit) {
  options_.per_class = 12;
  options_.splits = {{"train", 0.75}, {"val", 0.25}};
  campaign_.dataset().seed = 5;
  const auto summary = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_TRUE(summary) << summary.error().message;
  const std::map<std::string, int> train = {{"bolt", 9}, {"gear", 9}};
  const std::map<std::string, int> val = {{"bolt", 3}, {"gear", 3}};
  EXPECT_EQ(patches_by_class(summary->folder / "train"), train);
  EXPECT_EQ(patches_by_class(summary->folder / "val"), val);
  EXPECT_EQ(at(summary->splits[0].counts, Count::kAnnotations), 18);
  const auto verified = verify_export(campaign_.dataset(), export_formats(), summary->folder, 2);
  ASSERT_TRUE(verified) << verified.error().message;
  EXPECT_EQ(verified->differences, 0) << verified->first_differences.front();
}

TEST_F(ExportPatchesPerClass, WorkersChangeNothing) {
  options_.per_class = 15;
  const auto alone = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_TRUE(alone) << alone.error().message;
  const auto files = files_below(alone->folder);
  options_.workers = 4;
  options_.output = scratch_.path() / "again";
  const auto together = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_TRUE(together);
  EXPECT_EQ(files_below(together->folder), files);
}

TEST_F(ExportPatchesPerClass, MoreFramesAreChosenFromAnew) {
  options_.per_class = 15;
  ASSERT_TRUE(export_one(campaign_.dataset(), "patches", options_));
  for (int frame = 20; frame < 40; ++frame) {
    campaign_.add_frame(frame, frame / 2, floor_with_bolts(frame));
  }
  const auto again = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_TRUE(again) << again.error().message;
  const std::map<std::string, int> all = {{"bolt", 15}, {"gear", 15}};
  EXPECT_EQ(patches_by_class(again->folder), all);
}

TEST_F(ExportPatchesPerClass, WithTooFewFramesNothingIsWritten) {
  options_.per_class = 30;
  const auto summary = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message,
              AllOf(HasSubstr("bolt: 20 of 30"), HasSubstr("gear: 20 of 30"),
                    HasSubstr("about 33 frames")));
  EXPECT_FALSE(fs::exists(options_.output / "patches"));
  options_.windows_per_frame = 2;
  options_.patch_classes = {"gear"};
  EXPECT_TRUE(export_one(campaign_.dataset(), "patches", options_));
}

TEST_F(ExportPatchesPerClass, AWindowHoldsNothingButItsClass) {
  options_.patch_size = 0;
  options_.windows_per_frame = 3;
  const auto summary = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_TRUE(summary) << summary.error().message;
  int windows = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const auto image = read_png8(campaign_.frame_folder(frame) / "image.png");
    ASSERT_TRUE(image);
    for (int k = 1; k <= 3; ++k) {
      const auto window = read_png8(summary->folder / "train" / "gear" /
                                    fmt::format("{:06}_window{}.png", frame, k));
      ASSERT_TRUE(window) << window.error().message;
      const auto place = place_of(*window, *image);
      ASSERT_TRUE(place);
      const Image<std::uint16_t> ids = cropped(campaign_.truth(frame).ids, *place);
      EXPECT_TRUE(std::all_of(ids.values.begin(), ids.values.end(),
                              [](std::uint16_t id) { return id == 40; }));
      ++windows;
    }
  }
  EXPECT_EQ(windows, 60);
}

TEST_F(ExportPatchesPerClass, ShortSidesAreLeftOutAndCounted) {
  options_.min_side = 8;  // bolts are 9 × 7
  const auto summary = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_TRUE(summary) << summary.error().message;
  const std::map<std::string, int> gears = {{"gear", 20}};
  EXPECT_EQ(patches_by_class(summary->folder), gears);
  EXPECT_EQ(at(summary->splits[0].counts, Count::kTooSmall), 20);
}

TEST_F(ExportPatchesPerClass, NamesOfClassesAreChecked) {
  options_.windows = {"gaer"};
  auto summary = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message,
              HasSubstr("--windows: campaign 'parts' has no class 'gaer'"));
  EXPECT_THAT(summary.error().message, HasSubstr("did you mean 'gear'"));
  options_.windows = {"no"};
  summary = export_one(campaign_.dataset(), "patches", options_);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("name it with --classes, too"));
}

}  // namespace
}  // namespace seedframe
