// The list of formats, and that they tell the same of one campaign.
#include "formats/formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/annotate/coco_decoder.h"
#include "tests/annotate/yolo_decoder.h"
#include "tests/export/every_format.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

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
  const auto outcome = run_export(campaign.dataset(), formats, options);
  ASSERT_TRUE(outcome) << outcome.error().message;
  for (const ExportSummary& summary : outcome->written) {
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
