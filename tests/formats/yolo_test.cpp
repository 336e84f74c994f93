#include "formats/yolo.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "export/split.h"
#include "export/verify.h"
#include "tests/annotate/yolo_decoder.h"
#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class ExportYolo : public ::testing::Test {
 protected:
  ExportYolo() : campaign_(scratch_.path() / "campaign") {}
  ExportOptions options() const { return {.output = scratch_.path() / "out"}; }

  std::vector<yolo_decoder::Row> rows(const ExportSummary& summary, std::int64_t index) const {
    const fs::path path = summary.folder / "labels/train" / (frame_stem(index) + ".txt");
    EXPECT_TRUE(fs::exists(path)) << path;
    return yolo_decoder::parse_rows(*read_file(path));
  }

  ScratchFolder scratch_;
  SyntheticDataset campaign_;
};

IdImage two_instances() {
  IdImage ids(16, 10);
  for (const int row : {2, 3}) {
    for (int column = 4; column < 12; ++column) ids.at(row, column) = 3;
  }
  ids.at(9, 15) = 40;
  return ids;
}

TEST_F(ExportYolo, DetectionIsPinned) {
  campaign_.add_frame(41, 5, two_instances());
  const auto summary = export_one(campaign_.dataset(), "yolo-detect", options());
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(*read_file(summary->folder / "labels/train/000041.txt"),
            "0 0.50000000 0.30000000 0.50000000 0.20000000\n"
            "2 0.96875000 0.95000000 0.06250000 0.10000000\n");
  EXPECT_EQ(*read_file(summary->folder / "data.yaml"),
            "train: images/train\n"
            "val: images/train\n"
            "names:\n"
            "  0: \"bolt\"\n"
            "  1: \"no\"\n"
            "  2: \"gear\"\n"
            "  3: \"say \\\"über\\\"\"\n");
  EXPECT_EQ(*read_file(summary->folder / "data_with_nc.yaml"),
            "train: images/train\n"
            "val: images/train\n"
            "nc: 4\n"
            "names: [\"bolt\",\"no\",\"gear\",\"say \\\"über\\\"\"]\n");
}

TEST_F(ExportYolo, SegmentationIsPinned) {
  campaign_.add_frame(41, 5, two_instances());
  const auto summary = export_one(campaign_.dataset(), "yolo-segment", options());
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(*read_file(summary->folder / "labels/train/000041.txt"),
            "0 0.25125000 0.20200000 0.74875000 0.20200000 0.74875000 0.39800000 0.25125000 "
            "0.39800000\n"
            "2 0.93875000 0.90200000 0.99875000 0.90200000 0.99875000 0.99800000 0.93875000 "
            "0.99800000\n");
}

TEST_F(ExportYolo, DataYamlMeansTheSameToAYamlReader) {
  campaign_.add_ten_frames();
  ExportOptions split = options();
  split.splits = {{"train", 0.6}, {"val", 0.4}};
  campaign_.dataset().seed = 2;
  const auto summary = export_one(campaign_.dataset(), "yolo-detect", split);
  ASSERT_TRUE(summary) << summary.error().message;
  const YAML::Node yaml = YAML::LoadFile((summary->folder / "data.yaml").string());
  std::set<std::string> keys;
  for (const auto& entry : yaml) keys.insert(entry.first.as<std::string>());
  EXPECT_EQ(keys, (std::set<std::string>{"train", "val", "names"}));
  const YAML::Node counted = YAML::LoadFile((summary->folder / "data_with_nc.yaml").string());
  EXPECT_EQ(counted["nc"].as<int>(), 4);
  EXPECT_EQ(counted["names"].as<std::vector<std::string>>(), campaign_.dataset().categories);
  ASSERT_EQ(yaml["names"].size(), 4U);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(yaml["names"][i].as<std::string>(),
              campaign_.dataset().categories[static_cast<std::size_t>(i)]);
  }
  for (const std::string name : {"train", "val"}) {
    const std::string images = yaml[name].as<std::string>();
    EXPECT_EQ(images, "images/" + name);
    // Every image has its label file where the loaders look for it.
    int found = 0;
    for (const auto& entry : fs::directory_iterator(summary->folder / images)) {
      const std::string stem = entry.path().stem().string();
      EXPECT_TRUE(fs::exists(summary->folder / "labels" / name / (stem + ".txt"))) << stem;
      EXPECT_EQ(split_of_scene(std::stoi(stem) / 2, 2, split.splits) == 1, name == "val");
      ++found;
    }
    EXPECT_GT(found, 0);
  }
}

TEST_F(ExportYolo, DetectionBoxesAreThoseOfThePixels) {
  campaign_.add_ten_frames();
  const auto summary = export_one(campaign_.dataset(), "yolo-detect", options());
  ASSERT_TRUE(summary) << summary.error().message;
  int compared = 0;
  for (const CommittedFrame& frame : campaign_.frames()) {
    SCOPED_TRACE(frame.index);
    const auto expected = exported_instances(campaign_.truth(frame.index));
    const auto found = rows(*summary, frame.index);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].category, expected[i].category - 1);
      ASSERT_EQ(found[i].numbers.size(), 4U);
      const auto box = yolo_decoder::box_of_centre_row(found[i], 160, 120);
      const PixelRect& truth = expected[i].box;
      EXPECT_LE(yolo_decoder::box_error(box, truth.x, truth.y, truth.width, truth.height), 0.001);
      ++compared;
    }
  }
  EXPECT_GE(compared, 30);
}

/// Exports segments, decodes every row and compares it with the pixels.
void expect_segments(const SyntheticDataset& campaign, const ExportOptions& options,
                     yolo_decoder::ToPixels to_pixels, double box_tolerance_px) {
  const auto summary = export_one(campaign.dataset(), "yolo-segment", options);
  ASSERT_TRUE(summary) << summary.error().message;
  int one_part = 0;
  int several_parts = 0;
  int with_holes = 0;
  for (const CommittedFrame& frame : campaign.frames()) {
    SCOPED_TRACE(frame.index);
    const Truth& truth = campaign.truth(frame.index);
    const auto expected = exported_instances(truth);
    const auto found = yolo_decoder::parse_rows(
        *read_file(summary->folder / "labels/train" / (frame_stem(frame.index) + ".txt")));
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      SCOPED_TRACE(expected[i].name);
      EXPECT_EQ(found[i].category, expected[i].category - 1);
      ASSERT_GE(found[i].numbers.size(), 6U);
      for (const float number : found[i].numbers) {
        ASSERT_GE(number, 0.0F);
        ASSERT_LE(number, 1.0F);
      }
      const auto box = yolo_decoder::box_of_polygon_row(found[i], 160, 120);
      const PixelRect& pixels = expected[i].box;
      EXPECT_LE(yolo_decoder::box_error(box, pixels.x, pixels.y, pixels.width, pixels.height),
                box_tolerance_px);
      const Bitmap mask = bitmap_of(truth.ids, expected[i].id);
      const Bitmap decoded = yolo_decoder::bitmap_of_row(found[i], 160, 120, to_pixels);
      const Difference wrong = difference(decoded, mask);
      EXPECT_LE(wrong.lost + wrong.added, shortest_bridges(mask));  // 0 for one part
      ++(count_parts(mask) == 1 ? one_part : several_parts);
      with_holes += count_holes(mask) > 0;
    }
  }
  EXPECT_GE(one_part, 25);
  EXPECT_GE(several_parts, 3);
  EXPECT_GE(with_holes, 3);
}

TEST_F(ExportYolo, SegmentsDecodeToTheMasks) {
  campaign_.add_ten_frames();
  expect_segments(campaign_, options(), yolo_decoder::ToPixels::kTruncate, 0.0201);
}

TEST_F(ExportYolo, CentreVerticesDecodeToTheMasksInLoadersThatRound) {
  campaign_.add_ten_frames();
  ExportOptions centres = options();
  centres.polygon_vertices = PolygonVertices::kCentres;
  expect_segments(campaign_, centres, yolo_decoder::ToPixels::kRound, 0.5201);
  expect_segments(campaign_, centres, yolo_decoder::ToPixels::kTruncate, 0.5201);
}

TEST_F(ExportYolo, ABackgroundImageHasAnEmptyLabelFile) {
  campaign_.add_ten_frames();
  for (const char* task : {"yolo-detect", "yolo-segment", "yolo-obb", "yolo-pose"}) {
    const auto summary = export_one(campaign_.dataset(), task, options());
    ASSERT_TRUE(summary) << summary.error().message;
    const fs::path path = summary->folder / "labels/train/000003.txt";
    ASSERT_TRUE(fs::exists(path));
    EXPECT_EQ(fs::file_size(path), 0U);
    EXPECT_EQ(summary->splits[0].background_images, 1);
  }
}

TEST_F(ExportYolo, CountsRowsThatLoadersMerge) {
  campaign_.add_ten_frames();
  for (const char* task : {"yolo-detect", "yolo-segment", "yolo-obb", "yolo-pose"}) {
    const auto summary = export_one(campaign_.dataset(), task, options());
    ASSERT_TRUE(summary) << summary.error().message;
    EXPECT_EQ(rows(*summary, 8).size(), 3U);  // both are written
    if (task == std::string("yolo-obb")) {    // the rectangles of crossed bolts span other boxes
      EXPECT_EQ(at(summary->splits[0].counts, Count::kDuplicateRows), 0);
      continue;
    }
    EXPECT_EQ(at(summary->splits[0].counts, Count::kDuplicateRows), 1);
    ASSERT_EQ(summary->warnings.size(), 1U);
    EXPECT_THAT(summary->warnings[0], HasSubstr("train: 1 instances"));
  }
}

// Loaders compare whole rows of boxes and of poses, and of polygons and rectangles the box around.
TEST_F(ExportYolo, RowsOfPosesAreMergedOnlyIfTheirKeypointsAreTheSame) {
  campaign_.add_ten_frames();
  const fs::path path = campaign_.frame_folder(8) / frame_files::kLabels;
  Json labels = *parse_json(*read_file(path), "labels");
  for (Json& instance : labels["instances"]) {
    if (instance["id"] == 1) instance["keypoints"][0]["px"][0] = 61.0;
  }
  ASSERT_TRUE(write_quickly(path, readable_json(labels)));
  campaign_.write_manifest(campaign_.frames()[7]);
  for (const char* task : {"yolo-detect", "yolo-segment", "yolo-pose"}) {
    const auto summary = export_one(campaign_.dataset(), task, options());
    ASSERT_TRUE(summary) << summary.error().message;
    EXPECT_EQ(at(summary->splits[0].counts, Count::kDuplicateRows),
              task == std::string("yolo-pose") ? 0 : 1)
        << task;
  }
}

TEST_F(ExportYolo, RectanglesAreMergedByTheBoxAroundThem) {
  IdImage ids(40, 30);  // the corners of a square, and what is beside them
  for (const int row : {5, 13}) {
    for (const int column : {5, 13}) {
      ids.at(row, column) = 3;
      ids.at(row, column == 5 ? 6 : 12) = ids.at(row == 5 ? 6 : 12, column) = 1;
    }
  }
  campaign_.add_frame(0, 0, ids);
  const auto summary = export_one(campaign_.dataset(), "yolo-obb", options());
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(at(summary->splits[0].counts, Count::kDuplicateRows), 1);
}

TEST_F(ExportYolo, KnowsWhatTrainersLeaveBehind) {
  campaign_.add_ten_frames();
  const auto summary = export_one(campaign_.dataset(), "yolo-detect", options());
  ASSERT_TRUE(summary) << summary.error().message;
  const auto differences = [&] {
    return verify_export(campaign_.dataset(), export_formats(), summary->folder, 2)
        ->first_differences;
  };
  ASSERT_TRUE(write_quickly(summary->folder / "labels/train.cache", "pickled"));
  ASSERT_TRUE(write_quickly(summary->folder / "images/train/000000.npy", "pixels"));
  EXPECT_THAT(differences(), ::testing::IsEmpty());
  ASSERT_TRUE(write_quickly(summary->folder / "labels/train/000004.txt", "0 0.5 0.5 0.1 0.1\n"));
  ASSERT_TRUE(write_quickly(summary->folder / "images/train/000000.cache", "?"));
  EXPECT_THAT(differences(), ::testing::ElementsAre("images/train/000000.cache belongs to no frame",
                                                    "labels/train/000004.txt belongs to no frame"));
}

TEST_F(ExportYolo, RefusesImagesThatLoadersRefuse) {
  IdImage ids(64, 9);
  ids.at(4, 4) = 3;
  campaign_.add_frame(6, 0, ids);
  const auto summary = export_one(campaign_.dataset(), "yolo-detect", options());
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kInput);
  EXPECT_THAT(summary.error().message, HasSubstr("frame 6"));
  EXPECT_THAT(summary.error().message, HasSubstr("64x9"));
}

TEST_F(ExportYolo, ValNamesTheTrainingImagesWhenNoSceneFallsIntoIt) {
  campaign_.add_frame(0, 0, two_instances());
  ExportOptions split = options();
  split.splits = {{"train", 1.0 - 1e-9}, {"val", 1e-9}};
  const auto summary = export_one(campaign_.dataset(), "yolo-detect", split);
  ASSERT_TRUE(summary) << summary.error().message;
  const YAML::Node yaml = YAML::LoadFile((summary->folder / "data.yaml").string());
  EXPECT_EQ(yaml["val"].as<std::string>(), "images/train");
  EXPECT_THAT(summary->warnings, ::testing::ElementsAre(HasSubstr("no scene fell into val")));
}

}  // namespace
}  // namespace seedframe
