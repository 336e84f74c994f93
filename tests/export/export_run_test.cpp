// What holds for every format.
#include "export/export_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../annotate/coco_decoder.h"
#include "../annotate/yolo_decoder.h"
#include "export/export_index.h"
#include "export/verify.h"
#include "formats/formats.h"
#include "tests/export/synthetic_dataset.h"

namespace seedframe {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

const std::vector<std::string> kFormats = {
    "coco",         "coco-polygon", "coco-keypoints", "coco-panoptic", "yolo-detect",
    "yolo-segment", "yolo-obb",     "yolo-pose",      "voc",           "bop",
    "patches",      "webdataset",   "statistics"};

class EveryFormat : public ::testing::TestWithParam<std::string> {
 protected:
  EveryFormat() : campaign_(scratch_.path() / "campaign") {
    campaign_.dataset().seed = 2;
    campaign_.add_ten_frames();
    for (const char* name : {"bolt", "gear", "hidden", "nut", "rock"}) {
      auto asset = std::make_shared<Asset>();
      asset->name = name;
      asset->mesh.positions = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0.2F, 0}};
      asset->mesh.triangles = {{0, 1, 2}};
      campaign_.dataset().assets.push_back({asset, {}});
    }
  }

  Result<ExportSummary> run(const ExportOptions& options) {
    return export_one(campaign_.dataset(), GetParam(), options);
  }
  ExportOptions options() const { return {.output = output()}; }
  ExportOptions split_options() const {
    ExportOptions options{.output = output()};
    options.splits = {{"train", 0.6}, {"val", 0.4}};
    return options;
  }
  fs::path output() const { return scratch_.path() / "out"; }
  fs::path folder() const { return output() / GetParam(); }
  VerifySummary verified() {
    const auto summary = verify_export(campaign_.dataset(), export_formats(), folder(), 2);
    EXPECT_TRUE(summary) << summary.error().message;
    return summary ? *summary : VerifySummary{};
  }
  bool is_reused() const { return GetParam() != "statistics"; }

  ScratchFolder scratch_;
  SyntheticDataset campaign_;
};

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat, ::testing::ValuesIn(kFormats),
                         [](const auto& param) {
                           std::string name = param.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

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

TEST_P(EveryFormat, IsWhatItWasMadeFrom) {
  const auto summary = run(split_options());
  ASSERT_TRUE(summary) << summary.error().message;
  const VerifySummary found = verified();
  EXPECT_EQ(found.frames, 10);
  EXPECT_EQ(found.differences, 0) << ::testing::PrintToString(found.first_differences);
}

TEST_P(EveryFormat, ShowsAChangeOfAnyFile) {
  ASSERT_TRUE(run(split_options()));
  int changed = 0;
  for (const auto& [path, bytes] : files_below(folder())) {
    if (path == "seedframe.json" || path == "seedframe.index" || bytes.empty()) continue;
    if (path.rfind("models", 0) == 0 || path == "data.yaml" || path == "classes.json" ||
        path.find("labelmap") != std::string::npos) {
      continue;  // of no frame
    }
    SCOPED_TRACE(path);
    std::string other = bytes;
    other[other.size() / 2] ^= 1;
    ASSERT_TRUE(write_quickly(folder() / path, other));
    EXPECT_GT(verified().differences, 0);
    fs::remove(folder() / path);
    EXPECT_GT(verified().differences, 0);
    ASSERT_TRUE(write_quickly(folder() / path, bytes));
    ++changed;
  }
  EXPECT_GE(changed, 1);
  EXPECT_EQ(verified().differences, 0);
  ASSERT_TRUE(write_quickly(folder() / "stray.txt", "not of this export"));
  EXPECT_THAT(verified().first_differences, Contains(HasSubstr("belong to no frame")));
}

TEST_P(EveryFormat, ShowsSharedFilesOfNoFrame) {
  ExportOptions three = options();
  three.splits = {{"train", 1.0 - 1e-9}, {"val", 1e-9}};
  ASSERT_TRUE(run(three));  // val is empty
  EXPECT_EQ(verified().differences, 0);
  for (const auto& [path, bytes] : files_below(folder())) {
    const std::size_t split = path.find("train");
    if (split == std::string::npos || path.find("seedframe") != std::string::npos) continue;
    std::string other = path;
    other.replace(split, 5, "val");
    const auto before = read_file(folder() / other);
    fs::create_directories((folder() / other).parent_path());
    ASSERT_TRUE(write_quickly(folder() / other, bytes));
    EXPECT_GT(verified().differences, 0) << other;
    fs::remove(folder() / other);
    if (before) {
      ASSERT_TRUE(write_quickly(folder() / other, *before));
    }
  }
  EXPECT_EQ(verified().differences, 0);
}

TEST_P(EveryFormat, ShowsFramesThatCameAndWent) {
  ASSERT_TRUE(run(split_options()));
  campaign_.add_frame(12, 6, SyntheticDataset::discs(12));
  EXPECT_THAT(verified().first_differences, Contains(HasSubstr("frame 12: is not in the export")));
  campaign_.frames().pop_back();
  campaign_.frames().pop_back();
  EXPECT_THAT(verified().first_differences,
              Contains(HasSubstr("frame 10 is in the export, and not in the campaign")));
}

TEST_P(EveryFormat, ShowsFramesInAnotherSplit) {
  ASSERT_TRUE(run(split_options()));
  campaign_.dataset().seed = 3;  // draws other scenes into val
  if (!is_reused()) {
    EXPECT_THAT(verified().first_differences, Contains(HasSubstr("other numbers")));
    return;
  }
  EXPECT_THAT(verified().first_differences, Contains(HasSubstr("belongs to another split")));
}

TEST_P(EveryFormat, ShowsFilesThatTheIndexDoesNotList) {
  ASSERT_TRUE(run(split_options()));
  std::string index = *read_file(folder() / kIndexFile);
  const std::size_t files = index.find("\"files\":[[");
  if (files == std::string::npos) return;  // of the formats without files of their own
  index.erase(files + 9, index.find("]]", files) - files - 8);
  ASSERT_TRUE(write_quickly(folder() / kIndexFile, index));
  EXPECT_GT(verified().differences, 0);
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
  const fs::path source = campaign_.frame_folder(0) / frame_files::kImage;
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

TEST(ExportFormats, KnowWhatWasMeant) {
  std::vector<std::string> names;
  for (const FormatEntry& format : export_formats()) {
    names.emplace_back(format.name);
    EXPECT_STRNE(format.description, "");
    const auto found = find_format(export_formats(), format.name);
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, &format);
  }
  EXPECT_EQ(names, kFormats);
  const auto unknown = find_format(export_formats(), "yolo-detcet");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kInput);
  EXPECT_THAT(unknown.error().message, HasSubstr("did you mean 'yolo-detect'"));
}

/// One instance as a format tells it.
struct Told {
  int category = 0;
  PixelRect box;
  Bitmap mask;  ///< empty for detection
};
using ToldByFrame = std::map<std::int64_t, std::vector<Told>>;

ToldByFrame told_by_coco(const fs::path& folder) {
  const Json coco =
      *parse_json(*read_file(folder / "annotations/instances_train.json"), "instances");
  ToldByFrame told;
  for (const Json& annotation : coco.at("annotations")) {
    const auto box = annotation.at("bbox").get<std::array<int, 4>>();
    const Json& segmentation = annotation.at("segmentation");
    const Bitmap mask =
        segmentation.is_array()
            ? coco_decoder::bitmap_of_polygons(segmentation.get<std::vector<std::vector<double>>>(),
                                               120, 160)
            : coco_decoder::bitmap_of_runs(
                  coco_decoder::runs_of_string(segmentation.at("counts").get<std::string>()), 120,
                  160);
    told[annotation.at("image_id").get<std::int64_t>() - 1].push_back(
        {annotation.at("category_id").get<int>() - 1, {box[0], box[1], box[2], box[3]}, mask});
  }
  return told;
}

ToldByFrame told_by_yolo(const fs::path& folder, bool segments) {
  ToldByFrame told;
  for (const auto& entry : fs::directory_iterator(folder / "labels/train")) {
    const std::int64_t index = std::stoll(entry.path().stem().string());
    for (const auto& row : yolo_decoder::parse_rows(*read_file(entry.path()))) {
      const auto box = segments ? yolo_decoder::box_of_polygon_row(row, 160, 120)
                                : yolo_decoder::box_of_centre_row(row, 160, 120);
      const int x = static_cast<int>(std::lround(box.x0));
      const int y = static_cast<int>(std::lround(box.y0));
      told[index].push_back({row.category,
                             {x, y, static_cast<int>(std::lround(box.x1)) - x,
                              static_cast<int>(std::lround(box.y1)) - y},
                             segments ? yolo_decoder::bitmap_of_row(row, 160, 120) : Bitmap{}});
    }
  }
  return told;
}

TEST(ExportFormats, TellTheSame) {
  const ScratchFolder scratch;
  SyntheticDataset campaign(scratch.path() / "campaign");
  campaign.add_ten_frames();
  ExportOptions options{.output = scratch.path() / "out"};
  options.min_pixels = 20;
  std::vector<std::int64_t> counts;
  std::vector<const FormatEntry*> formats;
  for (const char* name : {"coco", "coco-polygon", "yolo-detect", "yolo-segment"}) {
    formats.push_back(*find_format(export_formats(), name));
  }
  const auto summaries = run_export(campaign.dataset(), formats, options);
  ASSERT_TRUE(summaries) << summaries.error().message;
  for (const ExportSummary& summary : *summaries) {
    counts.push_back(at(summary.splits[0].counts, Count::kAnnotations));
    EXPECT_GE(at(summary.splits[0].counts, Count::kTooSmall), 1);
  }
  EXPECT_GE(counts[0], 30);
  EXPECT_THAT(counts, ::testing::ElementsAre(counts[0], counts[0], counts[0], counts[0]));

  ToldByFrame rle = told_by_coco(options.output / "coco");
  ToldByFrame polygon = told_by_coco(options.output / "coco-polygon");
  ToldByFrame detect = told_by_yolo(options.output / "yolo-detect", false);
  ToldByFrame segment = told_by_yolo(options.output / "yolo-segment", true);
  std::int64_t compared = 0;
  for (const auto& [index, instances] : rle) {
    SCOPED_TRACE(index);
    ASSERT_EQ(polygon[index].size(), instances.size());
    ASSERT_EQ(detect[index].size(), instances.size());
    ASSERT_EQ(segment[index].size(), instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i, ++compared) {
      const Told& told = instances[i];
      for (const ToldByFrame* other : {&polygon, &detect, &segment}) {
        EXPECT_EQ(other->at(index)[i].category, told.category);
        EXPECT_EQ(other->at(index)[i].box, told.box);
      }
      EXPECT_EQ(polygon[index][i].mask.values, told.mask.values);
      const Difference wrong = difference(segment[index][i].mask, told.mask);
      EXPECT_LE(wrong.lost + wrong.added, shortest_bridges(told.mask));  // 0 for one part
    }
  }
  EXPECT_EQ(compared, counts[0]);
}

}  // namespace
}  // namespace seedframe
