// What loaders of YOLO's polygons make of them: ultralytics puts further points between vertices.
#include <algorithm>

#include <gtest/gtest.h>

#include "annotate/polygon.h"
#include "tests/annotate/mask_cases.h"
#include "tests/annotate/yolo_decoder.h"

namespace seedframe {
namespace {

using yolo_decoder::resampled;
using yolo_decoder::yolo_row;

// Two blocks, bridged in every direction: the bridge is as wide as it is drawn when a loader puts
// further points on it, on the way there and on the way back.
TEST(WholePolygon, BridgesAreOnePixelWideHoweverALoaderResamplesThem) {
  int bridged = 0;
  for (const int right : {-45, -31, -14, 0, 9, 23, 38}) {
    for (const int down : {-40, -27, -13, 0, 12, 25, 39}) {
      const MaskCase mask = mask_case("", 120, 110, [&](int row, int column) {
        const auto in_block = [&](int y, int x) {
          return row >= y && row < y + 8 && column >= x && column < x + 6;
        };
        return in_block(50, 55) || in_block(50 + down, 55 + right);
      });
      const Bitmap truth = bitmap_of(mask.ids);
      if (count_parts(truth) == 1) continue;
      SCOPED_TRACE(testing::Message() << right << " right, " << down << " down");
      const auto row =
          yolo_row(whole_polygon(mask_of(mask.ids), kInsidePixelEdges).polygon, 120, 110);
      const Bitmap written = yolo_decoder::bitmap_of_row(row, 120, 110);
      const Difference wrong = difference(written, truth);
      EXPECT_EQ(wrong.lost, 0);
      EXPECT_EQ(wrong.added, shortest_bridges(truth));
      EXPECT_EQ(yolo_decoder::bitmap_of_row(resampled(row), 120, 110).values, written.values);
      ++bridged;
    }
  }
  EXPECT_GE(bridged, 40);
}

/// Whether anywhere two mask pixels touch at a corner and nowhere else.
bool has_corner_contact(const Bitmap& mask) {
  for (int row = 0; row + 1 < mask.height; ++row) {
    for (int column = 0; column + 1 < mask.width; ++column) {
      const int down = mask.at(row, column) + mask.at(row + 1, column + 1);
      const int up = mask.at(row + 1, column) + mask.at(row, column + 1);
      if ((down == 2 && up == 0) || (down == 0 && up == 2)) return true;
    }
  }
  return false;
}

// ultralytics inserts points between the vertices. Where two pixels touch at a corner only, the
// outline passes through that corner, and a point that falls on it may be rounded to either side.
TEST(WholePolygon, ResamplingChangesNothingButWhereOnlyCornersTouch) {
  int exact = 0;
  int corner_contacts = 0;
  for (const MaskCase& mask : mask_cases()) {
    const Bitmap truth = bitmap_of(mask.ids);
    if (count_parts(truth) != 1) continue;
    SCOPED_TRACE(mask.name);
    const Polygon polygon = whole_polygon(mask_of(mask.ids), kInsidePixelEdges).polygon;
    const auto row = yolo_row(polygon, mask.ids.width, mask.ids.height);
    const Bitmap found =
        yolo_decoder::bitmap_of_row(resampled(row), mask.ids.width, mask.ids.height);
    if (has_corner_contact(truth)) {
      ASSERT_GE(intersection_over_union(found, truth), 0.94);
      ++corner_contacts;
    } else {
      ASSERT_EQ(found.values, truth.values);
      ++exact;
    }
  }
  EXPECT_GE(exact, 25);
  EXPECT_GE(corner_contacts, 40);
}

TEST(WholePolygon, IsTheSameToALoaderThatResamplesHoweverManyVerticesItHas) {
  int large = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const MaskCase mask = random_blobs(seed, 1280, 960);
    const auto row =
        yolo_row(whole_polygon(mask_of(mask.ids), kInsidePixelEdges).polygon, 1280, 960);
    SCOPED_TRACE(mask.name);
    EXPECT_EQ(yolo_decoder::bitmap_of_row(resampled(row), 1280, 960).values,
              yolo_decoder::bitmap_of_row(row, 1280, 960).values);
    large += row.numbers.size() > 2000;
  }
  EXPECT_GE(large, 1);
}

// Parts of a size that a camera sees: what bridges cost.
TEST(WholePolygon, SeveralPartsDecodeWellAtRealisticSizes) {
  int several = 0;
  double sum = 0.0;
  double worst_loaded = 1.0;
  for (std::uint64_t seed = 1000; seed < 1060; ++seed) {
    const MaskCase mask = random_blobs(seed, 320, 240);
    const Bitmap truth = bitmap_of(mask.ids);
    if (count_parts(truth) < 2) continue;
    SCOPED_TRACE(mask.name);
    const Polygon polygon = whole_polygon(mask_of(mask.ids), kInsidePixelEdges).polygon;
    const Bitmap found = yolo_decoder::bitmap_of_row(yolo_row(polygon, 320, 240), 320, 240);
    const double iou = intersection_over_union(found, truth);
    EXPECT_GE(iou, 0.97);
    sum += iou;
    const auto resampled_row = resampled(yolo_row(polygon, 320, 240));
    const Bitmap loaded = yolo_decoder::bitmap_of_row(resampled_row, 320, 240);
    worst_loaded = std::min(worst_loaded, intersection_over_union(loaded, truth));
    EXPECT_GE(intersection_over_union(loaded, truth), iou - 0.01);
    ++several;
  }
  ASSERT_GE(several, 20);
  RecordProperty("mean_iou", std::to_string(sum / several));
  RecordProperty("worst_loaded", std::to_string(worst_loaded));
  EXPECT_GE(sum / several, 0.99);
}

// Placed nearest to the pixels' coordinates, a polygon passes corners that only touch, and those of
// holes at bridges, at different places by x and y: pixels beside them are painted by a loader that
// puts points between.
TEST(WholePolygon, NearestPlacementIsNotExactAtCornersThatTouchAndAtHolesWhenResampled) {
  int compared = 0;
  double worst = 1.0;
  for (const MaskCase& mask : mask_cases()) {
    const Bitmap truth = bitmap_of(mask.ids);
    if (count_parts(truth) != 1) continue;
    SCOPED_TRACE(mask.name);
    const auto row = yolo_row(whole_polygon(mask_of(mask.ids), kNearestToPixels).polygon,
                              mask.ids.width, mask.ids.height);
    const Bitmap found =
        yolo_decoder::bitmap_of_row(resampled(row), mask.ids.width, mask.ids.height);
    if (has_corner_contact(truth) || count_holes(truth) > 0) {
      worst = std::min(worst, intersection_over_union(found, truth));
    } else {
      ASSERT_EQ(found.values, truth.values);
    }
    ++compared;
  }
  EXPECT_GE(compared, 60);
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 0.99) << "the page of the format says otherwise";
}

}  // namespace
}  // namespace seedframe
