#include "picture/canvas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/image_bytes.h"
#include "tests/picture/small_content.h"

namespace seedframe {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr DisplayColor kWhite = {1.0, 1.0, 1.0}, kBlack = {}, kRed = {1.0, 0.0, 0.0};

TEST(Canvas, BeginsWithItsBackground) {
  const Image<std::uint8_t> image = Canvas(3, 2, {0.2, 0.4, 0.6}).image();
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(pixel_at(image, 1, 2), (Pixel{51, 102, 153}));
}

TEST(Canvas, PutsPixelsAsTheyAreAndLeavesOutWhatIsOutside) {
  const Image<std::uint8_t> source = colorful_image(4, 3);
  for (const auto& [x, y] :
       {std::pair(1, 1), std::pair(-2, -1), std::pair(3, 2), std::pair(9, 9)}) {
    Canvas canvas(5, 4, kWhite);
    canvas.put(source, x, y);
    const Image<std::uint8_t> image = canvas.image();
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 5; ++column) {
        const int r = row - y, c = column - x;
        const bool covered = r >= 0 && c >= 0 && r < source.height && c < source.width;
        const Pixel expected = covered ? pixel_at(source, r, c) : Pixel{255, 255, 255};
        EXPECT_EQ(pixel_at(image, row, column), expected) << x << ", " << y;
      }
    }
  }
}

TEST(Canvas, FillsWholePixelsExactlyAndPartsOfThemPartly) {
  Canvas canvas(4, 1, kBlack);
  canvas.fill({1.0, 0.0, 1.5, 1.0}, kRed);
  const Image<std::uint8_t> image = canvas.image();
  EXPECT_EQ(pixel_at(image, 0, 0)[0], 0);
  EXPECT_EQ(pixel_at(image, 0, 1)[0], 255);
  EXPECT_NEAR(pixel_at(image, 0, 2)[0], 128, 1);
  EXPECT_EQ(pixel_at(image, 0, 3)[0], 0);
}

TEST(Canvas, OutlinesWithinTheBox) {
  Canvas canvas(6, 6, kBlack);
  canvas.outline({1.0, 1.0, 4.0, 4.0}, {.color = kRed, .width = 1.0});
  const Image<std::uint8_t> image = canvas.image();
  EXPECT_EQ(pixel_at(image, 0, 1)[0], 0);
  EXPECT_EQ(pixel_at(image, 1, 1)[0], 255);
  EXPECT_EQ(pixel_at(image, 4, 4)[0], 255);
  EXPECT_EQ(pixel_at(image, 2, 2)[0], 0);
  EXPECT_EQ(pixel_at(image, 5, 5)[0], 0);
}

TEST(Canvas, ARingInARingIsAHole) {
  Canvas canvas(6, 6, kBlack);
  canvas.rings({{{0, 0}, {6, 0}, {6, 6}, {0, 6}}, {{2, 2}, {2, 4}, {4, 4}, {4, 2}}},
               {.color = kRed, .is_filled = true});
  EXPECT_EQ(pixel_at(canvas.image(), 0, 0)[0], 255);
  EXPECT_EQ(pixel_at(canvas.image(), 3, 3)[0], 0);
}

TEST(Canvas, WritesWhateverBytesANameHas) {
  Canvas canvas(200, 20, kWhite);
  const TextStyle style{.size = 12.0, .color = kBlack};
  for (const std::string& name : {std::string("\xff\xfe"), std::string("a\0b", 3),
                                  std::string("\x1b[31m"), std::string("ü→"), std::string()}) {
    canvas.text(name, {2.0, 15.0}, style);
    EXPECT_GE(canvas.width_of(name, style), 0.0);
  }
  canvas.fill({0.0, 0.0, 200.0, 20.0}, kRed);  // a canvas in an error draws nothing any more
  EXPECT_EQ(pixel_at(canvas.image(), 10, 100), (Pixel{255, 0, 0}));
}

TEST(Canvas, ShortensATextToItsRoomWithoutHalfALetter) {
  Canvas canvas(10, 10, kWhite);
  const TextStyle style{.size = 12.0};
  EXPECT_EQ(canvas.fitted("gear", 500.0, style), "gear");
  const std::string name = "überaus lange Gehäusekappe mit Öffnungen";
  for (double room = 5.0; room < 300.0; room += 1.5) {
    const std::string fitted = canvas.fitted(name, room, style);
    if (fitted == name) break;
    EXPECT_TRUE(fitted.ends_with("…"));
    EXPECT_EQ(fitted.find("?"), std::string::npos) << fitted;
    if (fitted != "…") {
      EXPECT_LE(canvas.width_of(fitted, style), room);
    }
  }
}

TEST(Canvas, WrapsWordsIntoNoMoreLinesThanThereAre) {
  Canvas canvas(10, 10, kWhite);
  const TextStyle style{.size = 12.0};
  EXPECT_THAT(canvas.wrapped("one two\n three", 1000.0, 3, style), ElementsAre("one two three"));
  EXPECT_TRUE(canvas.wrapped("", 100.0, 3, style).empty());
  const auto lines = canvas.wrapped("one two three four five six seven", 60.0, 2, style);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_THAT(lines.back(), HasSubstr("…"));
}

TEST(Canvas, WrapsALongWordInPieces) {
  Canvas canvas(10, 10, kWhite);
  const TextStyle style{.size = 12.0};
  const std::string path = "/a/path/that/is/far/longer/than/its/tile/Größe.png";
  std::string together;
  for (const std::string& line : canvas.wrapped(path, 90.0, 20, style)) {
    EXPECT_LE(canvas.width_of(line, style), 90.0);
    together += line;
  }
  EXPECT_EQ(together, path);
  EXPECT_EQ(canvas.wrapped("ab", 1.0, 5, style).size(), 2U) << "a letter a line at least";
}

TEST(Canvas, DrawsTheSameAgain) {
  const auto draw = [] {
    Canvas canvas(80, 40, kWhite);
    canvas.text("hex_bolt", {3.3, 20.2}, {.size = 11.5, .color = kBlack, .bold = true});
    canvas.disc({40, 20}, 7.3, {.color = kRed, .width = 1.3});
    canvas.line({0, 0}, {80, 40}, {.color = kBlack, .dashed = true});
    return canvas.image().values;
  };
  EXPECT_EQ(draw(), draw());
}

}  // namespace
}  // namespace seedframe
