// What holds for every format when it is written.
#include "export/export_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/export_index.h"
#include "tests/export/every_format.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat, ::testing::ValuesIn(kFormats), name_of_format);

TEST_P(EveryFormat, WritesTheSameBytesAgainAndElsewhere) {
  const ExportOptions first = split_options();
  ASSERT_TRUE(run(first));
  const auto files = files_below(output());
  EXPECT_GE(files.size(), 3U);
  ASSERT_TRUE(run(first));  // takes over what is there
  EXPECT_EQ(files_below(output()), files);
  ExportOptions second = first;
  second.output = scratch_.path() / "another/deeper/place";
  second.link_images = true;
  second.workers = 4;
  ASSERT_TRUE(run(second));
  EXPECT_EQ(files_below(second.output), files);
  for (const auto& [path, bytes] : files) {
    EXPECT_EQ(bytes.find(scratch_.path().string()), std::string::npos) << path;
  }
}

TEST_P(EveryFormat, RedoesOnlyWhatChanged) {
  ASSERT_TRUE(run(split_options()));
  campaign_.add_frame(12, 6, SyntheticDataset::discs(12));
  campaign_.add_frame(13, 6, SyntheticDataset::discs(13));
  // Frame 5 is rendered anew.
  IdImage ids = campaign_.truth(5).ids;
  ids.at(60, 80) = ids.at(61, 80) = 40;
  campaign_.frames().clear();
  campaign_.add_ten_frames();
  campaign_.frames().erase(campaign_.frames().begin() + 4);
  campaign_.add_frame(5, 2, ids);
  std::rotate(campaign_.frames().begin() + 4, campaign_.frames().end() - 1,
              campaign_.frames().end());
  campaign_.add_frame(12, 6, SyntheticDataset::discs(12));
  campaign_.add_frame(13, 6, SyntheticDataset::discs(13));
  const auto again = run(split_options());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->frames, 12);
  EXPECT_EQ(again->reused, is_reused() ? 9 : 0);
  ExportOptions fresh = split_options();
  fresh.output = scratch_.path() / "fresh";
  ASSERT_TRUE(run(fresh));
  EXPECT_EQ(files_below(fresh.output), files_below(output()));
}

TEST_P(EveryFormat, TakesNothingOverThatWasChanged) {
  ASSERT_TRUE(run(split_options()));
  const auto before = files_below(output());
  for (const auto& [path, bytes] : before) {
    if (path.find("seedframe.json") != std::string::npos || bytes.empty()) continue;
    SCOPED_TRACE(path);
    std::string other = bytes;
    other[other.size() / 2] ^= 1;
    fs::remove(output() / path);  // it may share its bytes with the campaign
    ASSERT_TRUE(write_quickly(output() / path, other));
    const auto again = run(split_options());
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(files_below(output()), before);
  }
}

TEST_P(EveryFormat, TakesNothingOverFromOtherOptions) {
  ASSERT_TRUE(run(split_options()));
  ExportOptions other = split_options();
  other.min_pixels = 20;
  const auto again = run(other);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->reused, 0);
}

TEST_P(EveryFormat, TakesNothingOverFromAnotherDataset) {
  ASSERT_TRUE(run(split_options()));
  campaign_.dataset().keypoints[0].names.emplace_back("middle");  // shifts every row of yolo-pose
  auto again = run(split_options());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->reused, 0);
  EXPECT_EQ(verified().differences, 0);
  auto first = std::make_shared<Asset>();
  first->name = "anvil";  // shifts every object id of bop
  first->mesh.positions = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0.2F, 0}};
  first->mesh.triangles = {{0, 1, 2}};
  campaign_.dataset().assets.insert(campaign_.dataset().assets.begin(), {first, {}});
  again = run(split_options());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->reused, 0);
  EXPECT_EQ(verified().differences, 0);
}

TEST_P(EveryFormat, LeavesTheOldExportWhenItFailsAtAnyFrame) {
  ASSERT_TRUE(run(options()));
  const auto before = files_below(output());
  ExportOptions other = options();
  other.min_pixels = 400;  // another content, had the failed export replaced anything
  other.workers = 3;
  for (const CommittedFrame& frame : campaign_.frames()) {
    const fs::path labels = frame.folder / frame_files::kLabels;
    const std::string bytes = *read_file(labels);
    fs::remove(labels);
    const auto failed = run(other);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(failed.error().message, HasSubstr(fmt::format("frame {}", frame.index)));
    EXPECT_THAT(failed.error().message, HasSubstr("labels.json"));
    EXPECT_EQ(files_below(output()), before);
    EXPECT_EQ(std::distance(fs::directory_iterator(output()), {}), 1);  // nothing beside it
    ASSERT_TRUE(write_quickly(labels, bytes));
  }
  const auto summary = run(other);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_GT(at(summary->splits[0].counts, Count::kTooSmall), 0);
  EXPECT_NE(files_below(output()), before);
}

TEST_P(EveryFormat, NamesUpToTenBadFrames) {
  campaign_.add_frame(12, 6, SyntheticDataset::discs(12));
  for (const CommittedFrame& frame : campaign_.frames()) {
    ASSERT_TRUE(write_quickly(frame.folder / frame_files::kInstances, "no image"));
  }
  const auto failed = run(options());
  ASSERT_FALSE(failed);
  for (const std::int64_t index : {0, 1, 2, 3, 5, 6, 7, 8, 9, 10}) {
    EXPECT_THAT(failed.error().message, HasSubstr(fmt::format("frame {}:", index)));
  }
  EXPECT_THAT(failed.error().message, HasSubstr("and 1 more frames"));
}

TEST_P(EveryFormat, FailsAtLabelsThatDisagreeWithThePixels) {
  const fs::path path = campaign_.frame_folder(9) / frame_files::kLabels;
  Json labels = *parse_json(*read_file(path), "labels");
  Json& area = labels["instances"][0]["area_px"];
  ASSERT_GT(area.get<int>(), 1);
  area = area.get<int>() - 1;
  ASSERT_TRUE(write_file(path, readable_json(labels)));
  campaign_.write_manifest(campaign_.frames()[8]);
  const auto failed = run(options());
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(failed.error().message, HasSubstr("frame 9, instance 3"));
  EXPECT_FALSE(fs::exists(output() / GetParam()));
}

TEST_P(EveryFormat, ReplacesWhatAKilledExportLeft) {
  const fs::path left = output() / ("." + GetParam() + ".partial") / "images/train/000099.png";
  ASSERT_TRUE(make_folders(left.parent_path()));
  ASSERT_TRUE(write_file(left, "half an image"));
  const auto summary = run(options());
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_FALSE(fs::exists(summary->folder / "images/train/000099.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(output()), {}), 1);
}

TEST_P(EveryFormat, NeverReplacesAFolderThatIsNotAnExport) {
  const fs::path theirs = output() / GetParam() / "notes.txt";
  ASSERT_TRUE(make_folders(theirs.parent_path()));
  ASSERT_TRUE(write_file(theirs, "years of work"));
  const auto refused = run(options());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kInput);
  EXPECT_THAT(refused.error().message, HasSubstr("is not an export"));
  EXPECT_EQ(*read_file(theirs), "years of work");
}

TEST_P(EveryFormat, LinksOrCopiesImages) {
  const fs::path source = campaign_.frame_folder(0) / "image.png";
  for (const bool link : {true, false, true}) {
    ExportOptions chosen = options();
    chosen.link_images = link;
    ASSERT_TRUE(run(chosen));
    int same = 0;
    int images = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder())) {
      if (!entry.is_regular_file() || *read_file(entry.path()) != *read_file(source)) continue;
      ++images;
      same += fs::equivalent(entry.path(), source);
    }
    if (images == 0) return;  // of the formats without images
    EXPECT_EQ(same > 0, link);
  }
}

TEST_P(EveryFormat, RefusesImpossibleOptionsAndEmptyData) {
  const auto refuses = [this](const ExportOptions& bad) {
    const auto summary = run(bad);
    return !summary && summary.error().kind == ErrorKind::kInput &&
           !fs::exists(output() / GetParam());
  };
  for (const double share : {-0.1, 1.0, 2.0, std::nan("")}) {
    ExportOptions bad = options();
    bad.splits = {{"train", 1.0 - share}, {"val", share}};
    EXPECT_TRUE(refuses(bad)) << share;
  }
  ExportOptions bad = options();
  bad.min_pixels = 0;
  EXPECT_TRUE(refuses(bad));
  bad = options();
  bad.min_visible = 1.5;
  EXPECT_TRUE(refuses(bad));
  bad = options();
  bad.splits = {{"train", 1e-9}, {"val", 1.0 - 1e-9}};  // leaves nothing to train on
  EXPECT_TRUE(refuses(bad));
  Dataset& dataset = campaign_.dataset();
  std::vector<std::string> categories = {"\xff"};
  std::swap(dataset.categories, categories);
  EXPECT_TRUE(refuses(options()));
  dataset.categories.clear();
  EXPECT_TRUE(refuses(options()));
  std::swap(dataset.categories, categories);
  campaign_.frames().clear();
  EXPECT_TRUE(refuses(options()));
}

TEST_P(EveryFormat, HoldsWholeSilhouettesOnRequest) {
  ExportOptions amodal = options();
  amodal.amodal = true;
  const auto summary = run(amodal);
  if (GetParam() == "voc" || GetParam() == "coco-panoptic") {
    ASSERT_FALSE(summary);
    EXPECT_THAT(summary.error().message, HasSubstr("silhouettes overlap"));
    return;
  }
  ASSERT_TRUE(summary) << summary.error().message;
  const VerifySummary found = verified();
  EXPECT_EQ(found.differences, 0) << ::testing::PrintToString(found.first_differences);
}

TEST_P(EveryFormat, LeavesOutAndCountsWhatIsTooHidden) {
  ExportOptions seen = options();
  seen.min_visible = 0.5;
  const auto summary = run(seen);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_GE(at(summary->splits[0].counts, Count::kTooHidden), 3);
  EXPECT_EQ(verified().differences, 0);
}

TEST_P(EveryFormat, ReadsItsOptionsBackFromTheMarker) {
  ExportOptions many = split_options();
  many.min_pixels = 7;
  many.min_visible = 0.25;
  many.polygon_detail = PolygonDetail::kSimplified;
  many.patch_size = 0;
  many.shard_size = 2;
  const auto summary = run(many);
  ASSERT_TRUE(summary) << summary.error().message;
  const auto marker = read_marker(summary->folder);
  ASSERT_TRUE(marker) << marker.error().message;
  EXPECT_EQ(to_json(marker->options), to_json(many));
  EXPECT_EQ(marker->format, GetParam());
  EXPECT_EQ(marker->frames, 10);
  EXPECT_EQ(verified().differences, 0);
}

class SeveralFormats : public ::testing::Test {
 protected:
  Result<ExportOutcome> run(const std::vector<std::string>& names) {
    std::vector<const FormatEntry*> formats;
    for (const std::string& name : names) formats.push_back(*find_format(export_formats(), name));
    return run_export(campaign_.dataset(), formats, {.output = output_, .workers = 3});
  }

  ScratchFolder scratch_;
  SyntheticDataset campaign_{scratch_.path() / "campaign"};
  fs::path output_ = scratch_.path() / "out";
};

TEST_F(SeveralFormats, AreWrittenBesideOneThatCannotHoldTheDataset) {
  campaign_.dataset().categories[3] = "a:b";
  campaign_.add_ten_frames();
  const auto outcome = run({"voc", "coco", "yolo-detect"});
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->written.size(), 2U);
  EXPECT_EQ(outcome->written[0].frames, 10);
  ASSERT_EQ(outcome->impossible.size(), 1U);
  EXPECT_EQ(outcome->impossible[0].format, "voc");
  EXPECT_THAT(outcome->impossible[0].error.message, HasSubstr("'a:b'"));
  EXPECT_TRUE(fs::exists(output_ / "coco/seedframe.json"));
  EXPECT_FALSE(fs::exists(output_ / "voc"));
}

TEST_F(SeveralFormats, AreWrittenBesideOneThatCannotHoldAFrame) {
  campaign_.add_ten_frames();
  ASSERT_TRUE(run({"yolo-detect", "coco"}));
  const auto before = files_below(output_ / "yolo-detect");
  IdImage low(64, 9);
  low.at(4, 4) = 3;
  campaign_.add_frame(12, 6, low);
  campaign_.add_frame(13, 6, SyntheticDataset::discs(13));
  const auto outcome = run({"yolo-detect", "coco"});
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->written.size(), 1U);
  EXPECT_EQ(outcome->written[0].format, "coco");
  EXPECT_EQ(outcome->written[0].frames, 12);
  ASSERT_EQ(outcome->impossible.size(), 1U);
  EXPECT_THAT(outcome->impossible[0].error.message, HasSubstr("frame 12: YOLO loaders refuse"));
  EXPECT_EQ(files_below(output_ / "yolo-detect"), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(output_), {}), 2);  // nothing beside them
}

TEST_F(SeveralFormats, AreAllNamedWhenNoneIsPossible) {
  IdImage low(64, 9);
  low.at(4, 4) = 3;
  campaign_.add_frame(6, 0, low);
  const auto outcome = run({"yolo-detect", "yolo-obb"});
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, ErrorKind::kInput);
  EXPECT_THAT(outcome.error().message, HasSubstr("yolo-detect: frame 6"));
  EXPECT_THAT(outcome.error().message, HasSubstr("yolo-obb: frame 6"));
  EXPECT_EQ(std::distance(fs::directory_iterator(output_), {}), 0);
}

}  // namespace
}  // namespace seedframe
