// What holds for every format.
#include "export/exporter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../annotate/coco_decoder.h"
#include "../annotate/yolo_decoder.h"
#include "synthetic_dataset.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class EveryFormat : public ::testing::TestWithParam<std::string> {
 protected:
  EveryFormat() : campaign_(scratch_.path() / "campaign") { campaign_.add_ten_frames(); }

  Result<ExportSummary> run(const ExportOptions& options) {
    const auto format = find_export_format(GetParam());
    EXPECT_TRUE(format);
    return (*format)->run(campaign_.dataset(), options);
  }
  ExportOptions options() const { return {.output = output()}; }
  fs::path output() const { return scratch_.path() / "out"; }

  ScratchFolder scratch_;
  SyntheticDataset campaign_;
};

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         ::testing::Values("coco", "coco-polygon", "yolo-detect", "yolo-segment"),
                         [](const auto& param) {
                           std::string name = param.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(EveryFormat, WritesTheSameBytesAgainAndElsewhere) {
  ExportOptions first = options();
  first.val_share = 0.4;
  first.seed = 2;
  ASSERT_TRUE(run(first));
  const auto files = files_below(output());
  EXPECT_GT(files.size(), 11U);  // ten images, annotations and seedframe.json
  ASSERT_TRUE(run(first));
  EXPECT_EQ(files_below(output()), files);
  ExportOptions second = first;
  second.output = scratch_.path() / "another/deeper/place";
  second.link_images = false;
  ASSERT_TRUE(run(second));
  EXPECT_EQ(files_below(second.output), files);
  for (const auto& [path, bytes] : files) {
    EXPECT_EQ(bytes.find(scratch_.path().string()), std::string::npos) << path;
  }
}

TEST_P(EveryFormat, LeavesTheOldExportWhenItFails) {
  ASSERT_TRUE(run(options()));
  const auto before = files_below(output());
  const fs::path image = campaign_.frame_folder(10) / frame_files::kImage;
  const std::string bytes = *read_file(image);
  fs::remove(image);
  // Another filter would change the annotations, had the failed export replaced anything.
  ExportOptions other = options();
  other.min_pixels = 400;
  const auto failed = run(other);
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().message, HasSubstr("frame 10"));
  EXPECT_THAT(failed.error().message, HasSubstr("image.png"));
  EXPECT_EQ(files_below(output()), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(output()), {}), 1);  // nothing half-done beside it
  ASSERT_TRUE(write_file(image, bytes));
  const auto summary = run(other);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_GT(summary->splits[0].skipped_small, 0);
  EXPECT_NE(files_below(output()), before);
}

TEST_P(EveryFormat, FailsAtLabelsThatDisagreeWithThePixels) {
  const fs::path path = campaign_.frame_folder(9) / frame_files::kLabels;
  Json labels = *parse_json(*read_file(path), "labels");
  Json& area = labels["instances"][0]["area_px"];
  ASSERT_GT(area.get<int>(), 1);
  area = area.get<int>() - 1;
  ASSERT_TRUE(write_file(path, readable_json(labels)));
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
  auto summary = run(options());
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_TRUE(fs::equivalent(summary->folder / "images/train/000000.png", source));
  ExportOptions copies = options();
  copies.link_images = false;
  summary = run(copies);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_FALSE(fs::equivalent(summary->folder / "images/train/000000.png", source));
}

TEST_P(EveryFormat, RefusesImpossibleOptionsAndEmptyData) {
  const auto refuses = [this](const ExportOptions& bad) {
    const auto summary = run(bad);
    return !summary && summary.error().kind == ErrorKind::kInput && !fs::exists(output());
  };
  for (const double share : {-0.1, 1.0, 2.0, std::nan("")}) {
    ExportOptions bad = options();
    bad.val_share = share;
    EXPECT_TRUE(refuses(bad)) << share;
  }
  ExportOptions bad = options();
  bad.min_pixels = 0;
  EXPECT_TRUE(refuses(bad));
  bad = options();
  bad.val_share = 0.999999999;  // leaves nothing to train on
  EXPECT_TRUE(refuses(bad));
  Dataset& dataset = campaign_.dataset();
  std::vector<std::string> categories = {"\xff"};
  std::swap(dataset.categories, categories);
  EXPECT_TRUE(refuses(options()));
  dataset.categories.clear();
  EXPECT_TRUE(refuses(options()));
  std::swap(dataset.categories, categories);
  dataset.frames.clear();
  EXPECT_TRUE(refuses(options()));
}

TEST(ExportFormats, KnowWhatWasMeant) {
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) {
    names.emplace_back(format.name);
    EXPECT_STRNE(format.description, "");
    const auto found = find_export_format(format.name);
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, &format);
  }
  EXPECT_THAT(names, ElementsAre("coco", "coco-polygon", "yolo-detect", "yolo-segment"));
  const auto unknown = find_export_format("yolo-detcet");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kInput);
  EXPECT_THAT(unknown.error().message, HasSubstr("did you mean 'yolo-detect'"));
}

/// One instance as a format tells it.
struct Told {
  int category = 0;
  PixelBox box;
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
  for (const ExportFormat& format : export_formats()) {
    const auto summary = format.run(campaign.dataset(), options);
    ASSERT_TRUE(summary) << summary.error().message;
    counts.push_back(summary->splits[0].annotations);
    EXPECT_GE(summary->splits[0].skipped_small, 1);
  }
  EXPECT_GE(counts[0], 30);
  EXPECT_THAT(counts, ElementsAre(counts[0], counts[0], counts[0], counts[0]));

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
      EXPECT_EQ(wrong.lost, 0);
      EXPECT_LE(wrong.added, shortest_bridges(told.mask));  // 0 for one part
    }
  }
  EXPECT_EQ(compared, counts[0]);
}

}  // namespace
}  // namespace seedframe
