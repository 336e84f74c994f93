#include "formats/coco.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/split.h"
#include "tests/annotate/coco_decoder.h"
#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

Json read_coco(const fs::path& export_folder, const std::string& split = "train") {
  const fs::path path = export_folder / "annotations" / ("instances_" + split + ".json");
  return *parse_json(*read_file(path), path.string());
}

Bitmap decode(const Json& segmentation, int height, int width) {
  if (segmentation.is_object()) {
    EXPECT_EQ(segmentation.at("size"), Json({height, width}));
    const auto counts = segmentation.at("counts").get<std::string>();
    return coco_decoder::bitmap_of_runs(coco_decoder::runs_of_string(counts), height, width);
  }
  return coco_decoder::bitmap_of_polygons(segmentation.get<std::vector<std::vector<double>>>(),
                                          height, width);
}

class ExportCoco : public ::testing::TestWithParam<std::string> {
 protected:
  ExportCoco() : campaign_(scratch_.path() / "campaign") {}
  Result<ExportSummary> run(const ExportOptions& options) {
    return export_one(campaign_.dataset(), GetParam(), options);
  }
  ExportOptions options() const { return {.output = scratch_.path() / "out"}; }

  ScratchFolder scratch_;
  SyntheticDataset campaign_;
};

INSTANTIATE_TEST_SUITE_P(Masks, ExportCoco, ::testing::Values("coco", "coco-polygon"),
                         [](const auto& param) {
                           return param.param == "coco" ? "Rle" : "Polygon";
                         });

TEST_P(ExportCoco, HoldsExactlyTheMasksThatWereRendered) {
  campaign_.add_ten_frames();
  const auto summary = run(options());
  ASSERT_TRUE(summary) << summary.error().message;
  const Json coco = read_coco(summary->folder);
  std::map<std::int64_t, std::vector<Json>> annotations;
  std::set<std::int64_t> ids;
  for (const Json& annotation : coco.at("annotations")) {
    EXPECT_TRUE(ids.insert(annotation.at("id").get<std::int64_t>()).second);
    annotations[annotation.at("image_id").get<std::int64_t>()].push_back(annotation);
  }
  std::size_t compared = 0;
  for (const CommittedFrame& frame : campaign_.frames()) {
    SCOPED_TRACE(frame.index);
    const Truth& truth = campaign_.truth(frame.index);
    const std::vector<InstanceLabel> expected = exported_instances(truth);
    const std::vector<Json>& found = annotations[frame.index + 1];
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const PixelRect& box = expected[i].box;
      EXPECT_EQ(found[i].at("category_id"), expected[i].category);
      EXPECT_EQ(found[i].at("bbox"), Json({box.x, box.y, box.width, box.height}));
      EXPECT_EQ(found[i].at("area"), expected[i].area_px);
      EXPECT_EQ(found[i].at("iscrowd"), 0);
      EXPECT_EQ(found[i].at("id"), (frame.index + 1) * 100000 + expected[i].id);
      const Bitmap mask = decode(found[i].at("segmentation"), truth.ids.height, truth.ids.width);
      EXPECT_EQ(mask.values, bitmap_of(truth.ids, expected[i].id).values);
      ++compared;
    }
  }
  EXPECT_EQ(compared, coco.at("annotations").size());
  EXPECT_GE(compared, 30U);
}

TEST_P(ExportCoco, ListsEveryImageAndCategory) {
  campaign_.add_ten_frames();
  const auto summary = run(options());
  ASSERT_TRUE(summary) << summary.error().message;
  const Json coco = read_coco(summary->folder);
  Json categories = Json::array();
  for (const Json& category : coco.at("categories")) {
    categories.push_back({category.at("id"), category.at("name")});
  }
  EXPECT_EQ(categories, Json({{1, "bolt"}, {2, "no"}, {3, "gear"}, {4, "say \"über\""}}));
  ASSERT_EQ(coco.at("images").size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    const Json& image = coco.at("images")[i];
    const CommittedFrame& frame = campaign_.frames()[i];
    EXPECT_EQ(image.at("id"), frame.index + 1);
    EXPECT_EQ(image.at("width"), 160);
    EXPECT_EQ(image.at("height"), 120);
    EXPECT_EQ(image.at("seedframe_frame_id"), frame.frame_id);
    const fs::path path =
        summary->folder / "images" / "train" / image.at("file_name").get<std::string>();
    ASSERT_TRUE(fs::exists(path)) << path;
    EXPECT_EQ(*read_file(path), *read_file(frame.folder / "image.png"));
  }
  EXPECT_EQ(summary->frames, 10);
  ASSERT_EQ(summary->splits.size(), 1U);
  EXPECT_EQ(summary->splits[0].images, 10);
  EXPECT_EQ(summary->splits[0].background_images, 1);
  EXPECT_EQ(static_cast<std::size_t>(at(summary->splits[0].counts, Count::kAnnotations)),
            coco.at("annotations").size());
  EXPECT_TRUE(summary->warnings.empty());
}

TEST_P(ExportCoco, SplitsByScene) {
  campaign_.add_ten_frames();
  ExportOptions split = options();
  split.splits = {{"train", 0.6}, {"val", 0.4}};
  campaign_.dataset().seed = 2;
  const auto summary = run(split);
  ASSERT_TRUE(summary) << summary.error().message;
  std::set<std::int64_t> images;
  std::set<std::int64_t> annotations;
  for (const std::string name : {"train", "val"}) {
    const Json coco = read_coco(summary->folder, name);
    EXPECT_EQ(coco.at("categories").size(), 4U);
    EXPECT_FALSE(coco.at("images").empty());
    for (const Json& image : coco.at("images")) {
      const auto index = image.at("id").get<std::int64_t>() - 1;
      EXPECT_EQ(split_of_scene(static_cast<int>(index) / 2, 2, split.splits) == 1, name == "val");
      EXPECT_TRUE(images.insert(index).second);
      EXPECT_TRUE(fs::exists(summary->folder / "images" / name / (frame_stem(index) + ".png")));
    }
    for (const Json& annotation : coco.at("annotations")) {
      EXPECT_TRUE(annotations.insert(annotation.at("id").get<std::int64_t>()).second);
    }
  }
  EXPECT_EQ(images.size(), 10U);
  EXPECT_EQ(summary->splits.size(), 2U);
  EXPECT_EQ(summary->splits[0].images + summary->splits[1].images, 10);
}

TEST_P(ExportCoco, LeavesOutAndCountsSmallInstances) {
  campaign_.add_frame(8, 0, SyntheticDataset::crossed_bolts());
  ExportOptions large = options();
  large.min_pixels = 2;
  const auto summary = run(large);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(at(summary->splits[0].counts, Count::kAnnotations), 2);
  EXPECT_EQ(at(summary->splits[0].counts, Count::kTooSmall),
            1);  // the gear; not what is wholly hidden
  EXPECT_EQ(read_coco(summary->folder).at("annotations").size(), 2U);
}

class ExportCocoKinds : public ::testing::Test {
 protected:
  Json read(const ExportSummary& summary, const std::string& name) const {
    return *parse_json(*read_file(summary.folder / "annotations" / name), name);
  }
  ScratchFolder scratch_;
  SyntheticDataset campaign_{scratch_.path() / "campaign"};
  ExportOptions options_{.output = scratch_.path() / "out"};
};

TEST_F(ExportCocoKinds, KeypointsHaveTheNameThatImportersLookForAndLieInTheImage) {
  IdImage ids(16, 10);
  for (int column = 0; column < 4; ++column) ids.at(0, column) = 3;
  ids.at(5, 5) = 2;  // a nut, which has no keypoints
  campaign_.add_frame(0, 0, ids);
  const fs::path path = campaign_.frame_folder(0) / frame_files::kLabels;
  Json labels = *parse_json(*read_file(path), "labels");
  for (Json& instance : labels["instances"]) {
    if (instance["id"] != 3) continue;
    instance["keypoints"][0]["px"] = {0.25, 0.0};
    instance["keypoints"][1]["px"] = {15.9999, 9.75};
  }
  ASSERT_TRUE(write_quickly(path, readable_json(labels)));
  campaign_.write_manifest(campaign_.frames()[0]);
  options_.min_pixels = 2;
  const auto summary = export_one(campaign_.dataset(), "coco-keypoints", options_);
  ASSERT_TRUE(summary) << summary.error().message;
  const Json coco = read(*summary, "person_keypoints_train.json");
  ASSERT_EQ(coco.at("annotations").size(), 1U);
  EXPECT_EQ(coco["annotations"][0]["keypoints"], Json({0, 0, 2, 15.5, 9.25, 1}));
  EXPECT_EQ(at(summary->splits[0].counts, Count::kTooSmall), 0) << "the nut would not be there";
}

TEST_F(ExportCocoKinds, PanopticBackgroundIsStuffAndWhatIsLeftOutIsVoid) {
  IdImage ids(4, 2);
  ids.at(0, 0) = ids.at(0, 1) = 3;
  ids.at(1, 3) = 40;  // left out as too small
  ids.at(1, 0) = 4;   // a distractor
  campaign_.dataset().categories = {"bolt", "no", "gear", "background"};
  campaign_.add_frame(41, 0, ids);
  options_.min_pixels = 2;
  const auto summary = export_one(campaign_.dataset(), "coco-panoptic", options_);
  ASSERT_TRUE(summary) << summary.error().message;
  const Json coco = read(*summary, "panoptic_train.json");
  const Json& stuff = coco["categories"].back();
  EXPECT_EQ(stuff["id"], 5);
  EXPECT_EQ(stuff["isthing"], 0);
  EXPECT_EQ(stuff["name"], "background~5");  // a class is called background
  const Json& segments = coco["annotations"][0]["segments_info"];
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[1], Json({{"id", 65536},
                               {"category_id", 5},
                               {"area", 5},
                               {"bbox", {0, 0, 4, 2}},
                               {"iscrowd", 0}}));
  const auto png =
      decode_png8(*read_file(summary->folder / "annotations/panoptic_train/000041.png"), "");
  ASSERT_TRUE(png);
  EXPECT_EQ(png->values, (std::vector<std::uint8_t>{3, 0, 0, 3, 0, 0, 0, 0, 1, 0, 0, 1,  //
                                                    0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0}));
  // As detectron2 looks for the image; its content is the campaign's.
  EXPECT_EQ(coco["images"][0]["file_name"], "000041.jpg");
  EXPECT_EQ(*read_file(summary->folder / "images/train/000041.jpg"),
            *read_file(campaign_.frame_folder(41) / "image.png"));
}

TEST(CocoEntries, ArePinned) {
  const ScratchFolder scratch;
  SyntheticDataset campaign(scratch.path() / "campaign");
  campaign.dataset().categories = {"bolt", "nut", "gear"};
  campaign.dataset().keypoints.resize(3);
  IdImage ids(4, 3);
  ids.at(0, 0) = ids.at(1, 1) = 3;
  ids.at(2, 3) = 40;
  ids.at(2, 0) = 4;
  campaign.add_frame(41, 5, ids);
  const auto rle = export_one(campaign.dataset(), "coco", {.output = scratch.path()});
  ASSERT_TRUE(rle) << rle.error().message;
  const std::string head = R"({
"info":{"description":"Seedframe campaign 'parts'","version":"1"},
"licenses":[],
"categories":[
{"id":1,"name":"bolt","supercategory":"object"},
{"id":2,"name":"nut","supercategory":"object"},
{"id":3,"name":"gear","supercategory":"object"}
],
"images":[
{"file_name":"000041.png","height":3,"id":42,"seedframe_frame_id":"ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff1041","width":4}
],
"annotations":[
)";
  EXPECT_EQ(
      *read_file(rle->folder / "annotations/instances_train.json"),
      head +
          R"({"area":2,"bbox":[0,0,2,2],"category_id":1,"id":4200003,"image_id":42,"iscrowd":0,"segmentation":{"counts":"01304","size":[3,4]},"visible_fraction":0.3333333333333333},
{"area":1,"bbox":[3,2,1,1],"category_id":3,"id":4200040,"image_id":42,"iscrowd":0,"segmentation":{"counts":";1","size":[3,4]},"visible_fraction":0.5}
]
}
)");
  const auto polygons = export_one(campaign.dataset(), "coco-polygon", {.output = scratch.path()});
  ASSERT_TRUE(polygons) << polygons.error().message;
  EXPECT_EQ(
      *read_file(polygons->folder / "annotations/instances_train.json"),
      head +
          R"({"area":2,"bbox":[0,0,2,2],"category_id":1,"id":4200003,"image_id":42,"iscrowd":0,"segmentation":[[0,0,1,0,1,1,2,1,2,2,1,2,1,1,0,1]],"visible_fraction":0.3333333333333333},
{"area":1,"bbox":[3,2,1,1],"category_id":3,"id":4200040,"image_id":42,"iscrowd":0,"segmentation":[[3,2,4,2,4,3,3,3]],"visible_fraction":0.5}
]
}
)");
}

}  // namespace
}  // namespace seedframe
