#include "annotate/polygon.h"

#include <gtest/gtest.h>

#include "tests/annotate/coco_decoder.h"
#include "tests/annotate/mask_cases.h"
#include "tests/annotate/yolo_decoder.h"

namespace seedframe {
namespace {

/// Twice the area inside a polygon, in square hundredths of a pixel; positive when it runs
/// clockwise as seen in the image.
std::int64_t twice_area(const Polygon& polygon) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vertex& a = polygon[i];
    const Vertex& b = polygon[(i + 1) % polygon.size()];
    sum += std::int64_t{a.x} * b.y - std::int64_t{b.x} * a.y;
  }
  return sum;
}

Polygon pixels(std::vector<std::pair<int, int>> corners) {
  Polygon polygon;
  for (const auto& [x, y] : corners) polygon.push_back({100 * x, 100 * y});
  return polygon;
}

std::vector<double> coordinates(const Polygon& polygon) {
  std::vector<double> xy;
  for (const Vertex& vertex : polygon) {
    xy.push_back(vertex.x / 100.0);
    xy.push_back(vertex.y / 100.0);
  }
  return xy;
}

std::vector<std::vector<double>> coordinates(const std::vector<Polygon>& polygons) {
  std::vector<std::vector<double>> all;
  for (const Polygon& polygon : polygons) all.push_back(coordinates(polygon));
  return all;
}

TEST(BoundaryRings, OnePixelIsOneClockwiseSquare) {
  const MaskCase mask = mask_drawing("", {"...", ".#.", "..."});
  const std::vector<BoundaryRing> rings = boundary_rings(mask_of(mask.ids));
  ASSERT_EQ(rings.size(), 1U);
  EXPECT_FALSE(rings[0].hole);
  EXPECT_EQ(rings[0].polygon, pixels({{1, 1}, {2, 1}, {2, 2}, {1, 2}}));
}

TEST(BoundaryRings, AHoleRunsCounterclockwise) {
  const MaskCase mask = mask_drawing("", {"###", "#.#", "###"});
  const std::vector<BoundaryRing> rings = boundary_rings(mask_of(mask.ids));
  ASSERT_EQ(rings.size(), 2U);
  EXPECT_EQ(rings[0].polygon, pixels({{0, 0}, {3, 0}, {3, 3}, {0, 3}}));
  EXPECT_TRUE(rings[1].hole);
  EXPECT_EQ(twice_area(rings[1].polygon), -2 * 100 * 100);
}

TEST(BoundaryRings, PixelsThatTouchAtACornerAreOneRing) {
  const MaskCase mask = mask_drawing("", {"#.", ".#"});
  const std::vector<BoundaryRing> rings = boundary_rings(mask_of(mask.ids));
  ASSERT_EQ(rings.size(), 1U);
  EXPECT_EQ(rings[0].polygon,
            pixels({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}));
}

TEST(BoundaryRings, CountsAndAreasAreThoseOfTheMask) {
  int holes_seen = 0;
  for (const MaskCase& mask : mask_cases()) {
    SCOPED_TRACE(mask.name);
    const Bitmap truth = bitmap_of(mask.ids);
    int outer = 0;
    int holes = 0;
    std::int64_t area = 0;
    for (const BoundaryRing& ring : boundary_rings(mask_of(mask.ids))) {
      const std::int64_t twice = twice_area(ring.polygon);
      ASSERT_EQ(ring.hole, twice < 0);
      ++(ring.hole ? holes : outer);
      area += twice;
      ASSERT_GE(ring.polygon.size(), 4U);
    }
    ASSERT_EQ(outer, count_parts(truth));
    ASSERT_EQ(holes, count_holes(truth));
    ASSERT_EQ(area, 2 * 100 * 100 * mask_of(mask.ids).area_px());
    holes_seen += holes;
  }
  EXPECT_GT(holes_seen, 1000);
}

TEST(PartPolygons, AHoleIsReachedByABridgeThatIsWalkedBothWays) {
  const MaskCase mask = mask_drawing("", {"###", "#.#", "###"});
  const std::vector<Polygon> polygons = part_polygons(mask_of(mask.ids), kOnPixelEdges);
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(
      polygons[0],
      pixels({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {2, 2}, {2, 0}, {3, 0}, {3, 3}, {0, 3}}));
}

TEST(PartPolygons, DecodeToExactlyTheMaskOnPixelEdges) {
  int decoded = 0;
  for (const MaskCase& mask : mask_cases()) {
    SCOPED_TRACE(mask.name);
    const Bitmap truth = bitmap_of(mask.ids);
    const std::vector<Polygon> polygons = part_polygons(mask_of(mask.ids), kOnPixelEdges);
    ASSERT_EQ(polygons.size(), static_cast<std::size_t>(count_parts(truth)));
    for (const Polygon& polygon : polygons) {
      for (const Vertex& vertex : polygon) {
        ASSERT_EQ(vertex.x % kVerticesPerPixel, 0);
        ASSERT_EQ(vertex.y % kVerticesPerPixel, 0);
      }
    }
    const Bitmap found =
        coco_decoder::bitmap_of_polygons(coordinates(polygons), mask.ids.height, mask.ids.width);
    ASSERT_EQ(found.values, truth.values);
    ++decoded;
  }
  EXPECT_GE(decoded, 200);
}

// The decoder above must be able to see an error of one pixel edge, or the test above says nothing.
TEST(PartPolygons, TheDecoderNoticesARingThatIsOffByOnePixel) {
  const MaskCase mask = mask_drawing("", {"....", ".##.", ".##.", "...."});
  std::vector<Polygon> polygons = part_polygons(mask_of(mask.ids), kOnPixelEdges);
  for (Vertex& vertex : polygons[0]) vertex.x += kVerticesPerPixel;
  const Bitmap found = coco_decoder::bitmap_of_polygons(coordinates(polygons), 4, 4);
  EXPECT_NEAR(intersection_over_union(found, bitmap_of(mask.ids)), 1.0 / 3.0, 1e-12);
}

TEST(WholePolygon, IsEmptyForAnEmptyMask) {
  const MaskCase mask = mask_drawing("", {"..", ".."});
  EXPECT_TRUE(whole_polygon(mask_of(mask.ids), kInsidePixelEdges).polygon.empty());
}

TEST(WholePolygon, StandsTwoHundredthsInsideThePixelEdges) {
  const MaskCase mask = mask_drawing("", {"...", ".#.", "..."});
  EXPECT_EQ(whole_polygon(mask_of(mask.ids), kInsidePixelEdges).polygon,
            (Polygon{{102, 102}, {198, 102}, {198, 198}, {102, 198}}));
}

TEST(WholePolygon, JoinsPartsByTheShortestBridge) {
  const MaskCase mask = mask_drawing("", {"#....", ".....", "..###", "....."});
  const Polygon polygon = whole_polygon(mask_of(mask.ids), kInsidePixelEdges).polygon;
  const Bitmap found = yolo_decoder::bitmap_of_row(yolo_decoder::yolo_row(polygon, 5, 4), 5, 4);
  const MaskCase bridged = mask_drawing("", {"#....", ".#...", "..###", "....."});
  EXPECT_EQ(found.values, bitmap_of(bridged.ids).values);
}

TEST(WholePolygon, LeavesOutAFragmentThatIsSmallerThanItsBridge) {
  const MaskCase mask = mask_drawing("", {"###......#",  //
                                          "###......#",  //
                                          "#####....#",  //
                                          "..........",  //
                                          "......##..",  //
                                          "..........",  //
                                          "##########"});
  const WholePolygon whole = whole_polygon(mask_of(mask.ids), kInsidePixelEdges);
  EXPECT_EQ(whole.left_out_px, 0) << "a bridge of one pixel is worth two";
  const MaskCase far = mask_drawing("", {"###..........",  //
                                         "###..........",  //
                                         "###.......#..",  //
                                         "#............",  //
                                         "#............",  //
                                         "#............",  //
                                         "#............",  //
                                         "#############"});
  const WholePolygon left = whole_polygon(mask_of(far.ids), kInsidePixelEdges);
  EXPECT_EQ(left.left_out_px, 1) << "a bridge of four pixels is not";
  const Bitmap found =
      yolo_decoder::bitmap_of_row(yolo_decoder::yolo_row(left.polygon, 13, 8), 13, 8);
  const Difference wrong = difference(found, bitmap_of(far.ids));
  EXPECT_EQ(wrong.lost, 1);
  EXPECT_EQ(wrong.added, 0);
}

TEST(WholePolygon, KeepsAFragmentThatHoldsTheBox) {
  const MaskCase mask = mask_drawing("", {"###.......#",  //
                                          "###........"});
  EXPECT_EQ(whole_polygon(mask_of(mask.ids), kInsidePixelEdges).left_out_px, 0);
}

struct Decoded {
  int one_part = 0;
  int several_parts = 0;
  int with_holes = 0;
};

/// Every mask through YOLO's arithmetic: exact where there is one part, with holes or without; else
/// no more pixels are wrong, lost fragments and painted bridges together, than there are under the
/// shortest bridges.
Decoded decode_all(const VertexPlacement& placement, yolo_decoder::ToPixels to_pixels) {
  Decoded decoded;
  for (const MaskCase& mask : mask_cases()) {
    SCOPED_TRACE(mask.name);
    const Bitmap truth = bitmap_of(mask.ids);
    const int parts = count_parts(truth);
    if (parts == 0) continue;
    const int width = mask.ids.width;
    const int height = mask.ids.height;
    const Polygon polygon = whole_polygon(mask_of(mask.ids), placement).polygon;
    EXPECT_GE(polygon.size(), 3U);
    const yolo_decoder::Row row = yolo_decoder::yolo_row(polygon, width, height);
    const Bitmap found = yolo_decoder::bitmap_of_row(row, width, height, to_pixels);
    const Difference wrong = difference(found, truth);
    EXPECT_LE(wrong.lost + wrong.added, parts == 1 ? 0 : shortest_bridges(truth));
    ++(parts == 1 ? decoded.one_part : decoded.several_parts);
    decoded.with_holes += count_holes(truth) > 0;
  }
  return decoded;
}

TEST(WholePolygon, OnePartDecodesExactlyInALoaderThatTruncates) {
  const Decoded decoded = decode_all(kInsidePixelEdges, yolo_decoder::ToPixels::kTruncate);
  EXPECT_GE(decoded.one_part, 80);
  EXPECT_GE(decoded.several_parts, 80);
  EXPECT_GE(decoded.with_holes, 80);
}

TEST(WholePolygon, NearestPlacementDecodesExactlyInLoadersThatTruncateAndThatRound) {
  EXPECT_GE(decode_all(kNearestToPixels, yolo_decoder::ToPixels::kTruncate).one_part, 80);
  EXPECT_GE(decode_all(kNearestToPixels, yolo_decoder::ToPixels::kRound).one_part, 80);
}

TEST(WholePolygon, BoxIsWithinTwoHundredthsOfAPixel) {
  int checked = 0;
  for (const MaskCase& mask : mask_cases()) {
    const Mask view = mask_of(mask.ids);
    const Polygon polygon = whole_polygon(view, kInsidePixelEdges).polygon;
    if (polygon.empty()) continue;
    SCOPED_TRACE(mask.name);
    const auto row = yolo_decoder::yolo_row(polygon, mask.ids.width, mask.ids.height);
    const auto box = yolo_decoder::box_of_polygon_row(row, mask.ids.width, mask.ids.height);
    const PixelRect& truth = view.box();
    ASSERT_LE(yolo_decoder::box_error(box, truth.x, truth.y, truth.width, truth.height), 0.0201);
    ++checked;
  }
  EXPECT_GE(checked, 200);
}

}  // namespace
}  // namespace seedframe
