#include "page/thumbnail.h"

#include <gtest/gtest.h>

#include "page/sprite_sheet.h"

namespace seedframe {
namespace {

Image<std::uint8_t> plain(int width, int height, std::uint8_t value) {
  Image<std::uint8_t> image(width, height, 3);
  std::fill(image.values.begin(), image.values.end(), value);
  return image;
}

TEST(ThumbnailSizes, ShrinkWithTheNumberOfFramesAndKeepTheShape) {
  EXPECT_EQ(thumbnail_size(640, 480, 30), (ThumbnailSize{480, 360}));
  EXPECT_EQ(thumbnail_size(640, 480, 10'000), (ThumbnailSize{100, 75}));
  EXPECT_EQ(thumbnail_size(640, 480, 100'000'000), (ThumbnailSize{96, 72}));
  EXPECT_EQ(thumbnail_size(480, 640, 100'000'000), (ThumbnailSize{72, 96}));
}

TEST(ThumbnailSizes, AreNeverLargerThanThePictureNorNothing) {
  EXPECT_EQ(thumbnail_size(32, 32, 1), (ThumbnailSize{32, 32}));
  EXPECT_EQ(thumbnail_size(10'000, 1, 1), (ThumbnailSize{480, 1}));
}

TEST(Reduced, OfOneColourIsThatColour) {
  for (const int value : {0, 1, 127, 254, 255}) {
    const auto small = reduced(plain(37, 23, static_cast<std::uint8_t>(value)), {10, 7});
    for (const std::uint8_t found : small.values) EXPECT_NEAR(found, value, value < 8 ? 2 : 1);
  }
}

TEST(Reduced, MeansAreOfLight) {
  Image<std::uint8_t> image(2, 1, 3);
  image.at(0, 1, 0) = image.at(0, 1, 1) = image.at(0, 1, 2) = 255;
  EXPECT_NEAR(reduced(image, {1, 1}).at(0, 0), 188, 1) << "half the light, not half the code";
}

TEST(Reduced, CountsPixelsByTheAreaThatIsCovered) {
  Image<std::uint8_t> image(3, 1, 3);
  image.at(0, 1, 1) = 255;  // the middle, half in each
  const auto small = reduced(image, {2, 1});
  EXPECT_EQ(small.at(0, 0, 1), small.at(0, 1, 1));
  EXPECT_NEAR(small.at(0, 0, 1), 156, 1) << "a third of the light";
}

TEST(ReducedMask, HasTheObjectAtThePixelsCentre) {
  Image<std::uint16_t> ids(4, 2);
  ids.at(1, 1) = 7;
  ids.at(1, 3) = 300;
  ids.at(0, 0) = 9;
  const auto mask = reduced_mask(ids, {300, 7}, {2, 1});
  EXPECT_EQ(mask.at(0, 0), 2);
  EXPECT_EQ(mask.at(0, 1), 1);
  EXPECT_EQ(reduced_mask(ids, {300, 7}, {4, 2}).at(0, 0), 0) << "9 is none of these";
}

TEST(ReducedMask, HoldsMoreObjectsThanAByteAsOne) {
  Image<std::uint16_t> ids(1, 1);
  ids.at(0, 0) = 400;
  std::vector<int> many;
  for (int id = 1; id <= 400; ++id) many.push_back(id);
  EXPECT_EQ(reduced_mask(ids, many, {1, 1}).at(0, 0), 255);
}

TEST(Signature, IsTheMeanOfEachPart) {
  const PictureSignature signature = signature_of(plain(16, 16, 90));
  EXPECT_EQ(signature.front(), 90);
  EXPECT_DOUBLE_EQ(mean_luma(signature), 90.0);
  EXPECT_DOUBLE_EQ(mean_luma(signature_of(plain(3, 2, 200))), 200.0) << "smaller than its parts";
}

TEST(SpriteSheet, HoldsCellsInRowsAndIsTheSameAgain) {
  const SheetLayout layout = sheet_layout({96, 72});
  EXPECT_EQ(layout.columns, 16);
  EXPECT_EQ(layout.cells(), 16 * 21);
  const auto encoded = [&layout] {
    SpriteSheet sheet(layout, 20, /*has_pictures=*/true);
    Image<std::uint8_t> mask(96, 72);
    mask.at(5, 5) = 1;
    sheet.set(17, plain(96, 72, 200), mask);
    return *sheet.encode();
  };
  EXPECT_EQ(encoded(), encoded());
  EXPECT_TRUE(encoded().at("sprite").is_string());
}

TEST(SpriteSheet, WithoutPicturesHasMasksOnly) {
  SpriteSheet sheet(sheet_layout({4, 3}), 1, /*has_pictures=*/false);
  sheet.set(0, std::nullopt, Image<std::uint8_t>(4, 3));
  EXPECT_TRUE(sheet.encode()->at("sprite").is_null());
}

}  // namespace
}  // namespace seedframe
