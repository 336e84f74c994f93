#include "annotate/polygon_fill.h"

#include <gtest/gtest.h>

#include "annotate/extents.h"
#include "annotate/polygon_simplify.h"
#include "tests/annotate/coco_decoder.h"
#include "tests/annotate/mask_cases.h"

namespace seedframe {
namespace {

IdImage noise(std::uint64_t seed, int width, int height, int of_ten) {
  std::mt19937_64 random(seed);
  IdImage ids(width, height);
  for (auto& id : ids.values) id = static_cast<int>(random() % 10) < of_ten ? 1 : 0;
  return ids;
}

IdImage ring(int size, double outer, double inner) {
  IdImage ids(size, size);
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double middle = size / 2.0;
      if (in_disc(row, column, middle, middle, outer) &&
          !in_disc(row, column, middle, middle, inner)) {
        ids.at(row, column) = 1;
      }
    }
  }
  return ids;
}

std::size_t vertices(const std::vector<Polygon>& polygons) {
  std::size_t count = 0;
  for (const Polygon& polygon : polygons) count += polygon.size();
  return count;
}

/// By the tests' own decoder.
double coco_iou(const std::vector<Polygon>& polygons, const IdImage& ids) {
  std::vector<std::vector<double>> rings;
  for (const Polygon& polygon : polygons) {
    std::vector<double>& ring = rings.emplace_back();
    for (const Vertex& vertex : polygon) {
      ring.push_back(static_cast<double>(vertex.x) / kVerticesPerPixel);
      ring.push_back(static_cast<double>(vertex.y) / kVerticesPerPixel);
    }
  }
  const Bitmap found = coco_decoder::bitmap_of_polygons(rings, ids.height, ids.width);
  return intersection_over_union(found, bitmap_of(ids, 1));
}

TEST(CocoFill, AgreesWithTheDecoderOfTheTests) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const IdImage ids = ring(60, 20.0 + static_cast<double>(seed % 8), 3.0);
    const Mask mask = only_mask(ids);
    std::vector<Polygon> polygons = part_polygons(mask, kOnPixelEdges);
    EXPECT_EQ(polygon_iou(polygons, mask, FillRule::kCoco), 1.0);
    // Any vertices, also on half pixels, as simplified polygons have them.
    std::mt19937_64 random(seed);
    const PixelRect& box = mask.box();
    for (Polygon& polygon : polygons) {
      for (Vertex& vertex : polygon) {
        const auto near = [&](std::int32_t value, int begin, int size) {
          const int moved = value + 50 * (static_cast<int>(random() % 5) - 2);
          return std::clamp(moved, begin * kVerticesPerPixel, (begin + size) * kVerticesPerPixel);
        };
        vertex = {near(vertex.x, box.x, box.width), near(vertex.y, box.y, box.height)};
      }
    }
    EXPECT_NEAR(polygon_iou(polygons, mask, FillRule::kCoco), coco_iou(polygons, ids), 1e-12)
        << seed;
  }
}

TEST(PolygonFill, GivesTheMaskBackFromEveryPlacement) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const IdImage ids = noise(seed, 23, 17, static_cast<int>(1 + seed % 9));
    const Mask mask = only_mask(ids);
    EXPECT_EQ(polygon_iou(part_polygons(mask, kOnPixelEdges), mask, FillRule::kCentres), 1.0)
        << seed;
    const WholePolygon whole = whole_polygon(mask, kInsidePixelEdges);
    const auto area = static_cast<double>(mask.area_px());
    EXPECT_EQ(polygon_iou({whole.polygon}, mask, FillRule::kCentres),
              (area - static_cast<double>(whole.left_out_px)) / area)
        << seed;
  }
}

TEST(PolygonFill, SeesAPixelTooManyOrTooFew) {
  IdImage ids(12, 12);
  for (int row = 3; row < 8; ++row) {
    for (int column = 2; column < 9; ++column) ids.at(row, column) = 1;
  }
  const Mask mask = only_mask(ids);
  const auto polygons = part_polygons(mask, kOnPixelEdges);
  ids.at(5, 5) = 0;
  EXPECT_NEAR(polygon_iou(polygons, mask, FillRule::kCentres), 34.0 / 35.0, 1e-12);
  Polygon beyond = polygons[0];
  for (Vertex& vertex : beyond) vertex.x += kVerticesPerPixel;
  EXPECT_EQ(polygon_iou({beyond}, mask, FillRule::kCentres), 0.0) << "it leaves the box";
}

TEST(PolygonSimplify, SavesVerticesOfLargeMasksAtTheStatedIou) {
  for (const double inner : {0.0, 30.0}) {
    const IdImage ids = ring(200, 80.0, inner);
    const Mask mask = only_mask(ids);
    const auto exact = part_polygons(mask, kOnPixelEdges);
    const auto fewer = simplified_polygons(mask);
    EXPECT_LT(vertices(fewer), vertices(exact) / 5);
    EXPECT_GE(coco_iou(fewer, ids), kLeastSimplifiedIou);
  }
}

TEST(PolygonSimplify, LeavesExactWhatCannotBeSimpler) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const IdImage ids = noise(seed, 15, 15, 5);
    const Mask mask = only_mask(ids);
    EXPECT_GE(coco_iou(simplified_polygons(mask), ids), kLeastSimplifiedIou);
  }
  IdImage pixel(5, 5);
  pixel.at(2, 2) = 1;
  const Mask mask = only_mask(pixel);
  EXPECT_EQ(simplified_polygons(mask), part_polygons(mask, kOnPixelEdges));
}

}  // namespace
}  // namespace seedframe
