#include "picture/frame_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "picture/pixel_layers.h"
#include "tests/picture/small_content.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

FramePicture small_picture(const LayerSet& layers, const FrameContent& content = small_content()) {
  return draw_frame(content, layers, tile_size(8, 6, 80, 80));
}

TEST(TileSize, ShrinksToItsWidthAndNeverEnlargesByParts) {
  EXPECT_EQ(tile_size(640, 480, 320).width, 320);
  EXPECT_EQ(tile_size(640, 480, 320).height, 240);
  EXPECT_EQ(tile_size(640, 480, 320).scale, 0.5);
  EXPECT_EQ(tile_size(200, 100, 320).width, 200) << "as it is";
  EXPECT_EQ(tile_size(64, 48, 320, 160).width, 192) << "three times as large";
  EXPECT_EQ(tile_size(200, 100, 320, 320).width, 200) << "twice is too wide";
  EXPECT_EQ(tile_size(20'000, 1, 100).height, 1) << "there is always a row";
}

TEST(FramePicture, HasTheTilesSizeWhateverItShows) {
  FrameContent content = small_content();
  content.depth.emplace(8, 6);
  content.normal.emplace(8, 6, 3);
  content.disagreement.emplace(8, 6);
  for (std::size_t i = 0; i < kLayerCount; ++i) {
    const FramePicture picture = small_picture({static_cast<Layer>(i)}, content);
    EXPECT_EQ(picture.pixels.width, 80) << kLayerNames[i];
    EXPECT_EQ(picture.pixels.height, 60);
    EXPECT_EQ(picture.pixels.values, small_picture({static_cast<Layer>(i)}, content).pixels.values)
        << "the same again";
  }
}

TEST(FramePicture, DrawsBoxesOfClassesAroundTheirPixels) {
  const Image<std::uint8_t> pixels = small_picture({Layer::kBoxes}).pixels;
  EXPECT_EQ(pixel_at(pixels, 30, 10), color_bytes(class_color(2))) << "the bolt's upper side";
  EXPECT_EQ(pixel_at(pixels, 40, 10), color_bytes(kBackdrop)) << "within it";
  EXPECT_EQ(pixel_at(pixels, 49, 29), color_bytes(class_color(2))) << "its lower right corner";
  EXPECT_EQ(pixel_at(pixels, 45, 60), color_bytes(kBackdrop)) << "a distractor has none";
}

TEST(FramePicture, OutlinesWholeObjectsAlsoBehindOthersAndBeyondTheImage) {
  const Image<std::uint8_t> pixels = small_picture({Layer::kAmodal}).pixels;
  EXPECT_NE(pixel_at(pixels, 40, 50), color_bytes(kBackdrop)) << "where the bolt is hidden";
  EXPECT_NE(pixel_at(pixels, 30, 0), color_bytes(kBackdrop)) << "it goes on beyond the edge";
  EXPECT_EQ(pixel_at(pixels, 40, 25), color_bytes(kBackdrop)) << "within it";
}

TEST(FramePicture, NamesClassesOnTheirColours) {
  FrameContent content = small_content();
  const Image<std::uint8_t> named =
      draw_frame(content, {Layer::kNames}, tile_size(8, 6, 320, 320)).pixels;
  const auto is_gear_colour = [&](int row, int column) {
    return named.at(row, column, 1) > 100 && named.at(row, column, 2) < 60;
  };
  int on_gear_colour = 0;
  for (int row = 0; row < named.height; ++row) {
    for (int column = 0; column < named.width; ++column)
      on_gear_colour += is_gear_colour(row, column);
  }
  EXPECT_GT(on_gear_colour, 200);
  content.labels.categories[0] = "\xff\x00 strange \x1b[31m name that is long, very long";
  draw_frame(content, {Layer::kNames}, tile_size(8, 6, 320, 320));
}

TEST(FramePicture, MarksKeypointsAndJoinsThem) {
  FrameContent content = small_content();
  content.labels.instances[0].keypoints = {{"head", {1.0, 1.0}, Visibility::kVisible},
                                           {"tip", {6.0, 1.0}, Visibility::kHidden},
                                           {"out", {4.0, 5.0}, Visibility::kOutside}};
  const TileSize size = tile_size(8, 6, 160, 160);
  const Skeletons skeletons = {{{"head", "tip"}, {"tip", "out"}}, {}};
  const Image<std::uint8_t> alone = draw_frame(content, {Layer::kKeypoints}, size).pixels;
  const Image<std::uint8_t> joined =
      draw_frame(content, {Layer::kKeypoints}, size, skeletons).pixels;
  EXPECT_EQ(pixel_at(alone, 20, 20), color_bytes(class_color(1))) << "visible: filled";
  EXPECT_EQ(pixel_at(alone, 20, 120), (Pixel{255, 255, 255})) << "hidden: a ring";
  EXPECT_EQ(pixel_at(alone, 20, 70), color_bytes(kBackdrop));
  EXPECT_EQ(pixel_at(joined, 20, 70), color_bytes(class_color(1)));
  EXPECT_EQ(pixel_at(joined, 100, 80), color_bytes(kBackdrop)) << "outside of the image";
}

TEST(FramePicture, SaysWhatThereIsNot) {
  FrameContent content = small_content();
  content.absent[Layer::kImage] = "nothing was rendered";
  const FramePicture boxes = small_picture({Layer::kImage, Layer::kBoxes}, content);
  EXPECT_EQ(boxes.note, "no image");
  EXPECT_EQ(pixel_at(boxes.pixels, 30, 10), color_bytes(class_color(2))) << "the rest is shown";
  const FramePicture alone = small_picture({Layer::kImage}, content);
  EXPECT_EQ(alone.note, "");
  EXPECT_EQ(alone.pixels.width, 80);
  EXPECT_NE(alone.pixels.values, small_picture({Layer::kImage}).pixels.values);
}

TEST(FramePicture, TellsNumbersWithTheirUnits) {
  FrameContent content = small_content();
  content.depth.emplace(8, 6);
  std::fill(content.depth->values.begin(), content.depth->values.end(), 0.25F);
  EXPECT_EQ(small_picture({Layer::kDepth}, content).note, "0.25 to 0.25 m");
  content.disagreement.emplace(8, 6);
  EXPECT_EQ(small_picture({Layer::kDisagreement}, content).note, "no pixel differs");
  content.disagreement->at(0, 0) = 255;
  EXPECT_EQ(small_picture({Layer::kDisagreement}, content).note, "1 px inside, 0 px at edges");
}

TEST(MessageTile, HasItsSizeAndWordsWhereThereIsRoom) {
  const TileSize size{200, 100, 1.0};
  const Image<std::uint8_t> one = draw_message("failed", "the worker crashed", size);
  EXPECT_EQ(one.width, 200);
  EXPECT_EQ(one.height, 100);
  EXPECT_NE(one.values, draw_message("failed", "it was killed", size).values);
  const std::string endless(5000, 'x');
  EXPECT_EQ(draw_message(endless, endless, size).height, 100);
  EXPECT_EQ(draw_message("failed", "no room", {1, 1, 1.0}).width, 1);
}

}  // namespace
}  // namespace seedframe
