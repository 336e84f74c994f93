#include "picture/pixel_layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rays/ray_scene.h"
#include "tests/picture/small_content.h"

namespace seedframe {
namespace {

TEST(PixelLayers, OfTheImageAreItsPixels) {
  const FrameContent content = small_content();
  EXPECT_EQ(pixels_of(content, {Layer::kImage}).values, content.image->values);
  EXPECT_EQ(pixels_of(content, {Layer::kImage, Layer::kBoxes}).values, content.image->values);
}

TEST(PixelLayers, OfMasksAreTheColoursOfClassesOnExactlyTheirPixels) {
  const FrameContent content = small_content();
  const Image<std::uint8_t> semantic = pixels_of(content, {Layer::kSemantic});
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 8; ++column) {
      const int id = content.instance_ids.at(row, column);
      const DisplayColor expected = id == 1 || id == 2 ? class_color(1)
                                    : id == 3          ? class_color(2)
                                                       : kBackdrop;
      EXPECT_EQ(pixel_at(semantic, row, column), color_bytes(expected)) << row << ", " << column;
    }
  }
}

TEST(PixelLayers, OfInstancesTellThemApart) {
  const FrameContent content = small_content();
  const Image<std::uint8_t> instances = pixels_of(content, {Layer::kInstances});
  EXPECT_EQ(pixel_at(instances, 0, 0), color_bytes(instance_color(1, 0)));
  EXPECT_EQ(pixel_at(instances, 0, 3), color_bytes(instance_color(1, 1)));
  EXPECT_NE(pixel_at(instances, 0, 0), pixel_at(instances, 0, 3));
  EXPECT_EQ(pixel_at(instances, 5, 7), color_bytes(class_color(0))) << "a distractor has a mask";
  EXPECT_EQ(pixel_at(instances, 2, 2), color_bytes(kBackdrop));
}

TEST(PixelLayers, OfMasksOverTheImageLetItShineThrough) {
  FrameContent content = small_content();
  const auto before = pixel_at(pixels_of(content, {Layer::kImage, Layer::kInstances}), 0, 0);
  std::fill(content.image->values.begin(), content.image->values.end(), std::uint8_t{0});
  EXPECT_NE(pixel_at(pixels_of(content, {Layer::kImage, Layer::kInstances}), 0, 0), before);
  const auto background = pixel_at(pixels_of(content, {Layer::kImage, Layer::kInstances}), 2, 2);
  EXPECT_EQ(background[0], background[2]) << "what is not masked is grey";
}

TEST(PixelLayers, OfDepthBeginAndEndWithWhatIsSeen) {
  FrameContent content = small_content();
  content.depth.emplace(8, 6);
  for (std::size_t i = 0; i < 48; ++i) content.depth->values[i] = 1.0F + static_cast<float>(i);
  content.depth->at(0, 1) = kNoDepth;
  content.depth->at(0, 2) = std::numeric_limits<float>::quiet_NaN();
  const auto range = depth_range(*content.depth);
  ASSERT_TRUE(range);
  EXPECT_EQ((*range)[0], 1.0);
  EXPECT_EQ((*range)[1], 48.0);
  const Image<std::uint8_t> pixels = pixels_of(content, {Layer::kDepth});
  EXPECT_EQ(pixel_at(pixels, 0, 0), color_bytes(depth_color(1.0))) << "near is bright";
  EXPECT_EQ(pixel_at(pixels, 5, 7), color_bytes(depth_color(0.0)));
  EXPECT_EQ(pixel_at(pixels, 0, 1), color_bytes(kBackdrop));
  EXPECT_EQ(pixel_at(pixels, 0, 2), color_bytes(kBackdrop));
}

TEST(PixelLayers, OfDepthWithoutAnythingSeenAreTheBackdrop) {
  FrameContent content = small_content();
  content.depth.emplace(8, 6);
  std::fill(content.depth->values.begin(), content.depth->values.end(), kNoDepth);
  EXPECT_FALSE(depth_range(*content.depth));
  EXPECT_EQ(pixel_at(pixels_of(content, {Layer::kDepth}), 3, 3), color_bytes(kBackdrop));
}

TEST(PixelLayers, OfNormalsAreDirectionsAsColours) {
  FrameContent content = small_content();
  content.normal.emplace(8, 6, 3);
  content.normal->at(0, 0, 2) = 1.0F;
  const Image<std::uint8_t> pixels = pixels_of(content, {Layer::kNormals});
  EXPECT_EQ(pixel_at(pixels, 0, 0), (Pixel{128, 128, 255}));
  EXPECT_EQ(pixel_at(pixels, 0, 1), color_bytes(kBackdrop)) << "nothing is there";
}

TEST(PixelLayers, OfTheDisagreementMarkPixelsByKind) {
  FrameContent content = small_content();
  content.disagreement.emplace(8, 6);
  content.disagreement->at(1, 1) = 255;
  content.disagreement->at(1, 2) = content.disagreement->at(1, 3) = 128;
  content.disagreement->at(2, 2) = 64;
  const DisagreementCount count = count_disagreement(*content.disagreement);
  EXPECT_EQ(count.inside_px, 1);
  EXPECT_EQ(count.edge_px, 2);
  EXPECT_EQ(count.coincident_px, 1);
  for (const LayerSet& layers :
       {LayerSet{Layer::kDisagreement}, LayerSet{Layer::kImage, Layer::kDisagreement}}) {
    const Image<std::uint8_t> pixels = pixels_of(content, layers);
    EXPECT_EQ(pixel_at(pixels, 1, 1), color_bytes(kInsideColor));
    EXPECT_EQ(pixel_at(pixels, 1, 3), color_bytes(kEdgeColor));
    EXPECT_EQ(pixel_at(pixels, 2, 2), color_bytes(kCoincidentColor));
    EXPECT_EQ(pixel_at(pixels, 4, 4)[0], pixel_at(pixels, 4, 4)[1]);
  }
}

}  // namespace
}  // namespace seedframe
