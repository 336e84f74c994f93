#include "picture/contact_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/image_bytes.h"
#include "tests/fixtures/message_of.h"
#include "tests/picture/small_content.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

ContactSheet plain_sheet(int tiles, int columns) {
  ContactSheet sheet;
  sheet.columns = columns;
  for (int i = 0; i < tiles; ++i) sheet.tiles.push_back({colorful_image(20, 10), "", ""});
  return sheet;
}

std::vector<std::string> texts(const std::vector<LegendEntry>& legend) {
  std::vector<std::string> texts;
  for (const LegendEntry& entry : legend) texts.push_back(entry.text);
  return texts;
}

TEST(ContactSheet, OfTilesAloneHasGapsAndNothingElse) {
  const auto picture = draw_sheet(plain_sheet(5, 3));
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 3 * 20 + 2 * 6);
  EXPECT_EQ(picture->height, 2 * 10 + 6);
  const Image<std::uint8_t> tile = colorful_image(20, 10);
  for (int column = 0; column < 20; ++column) {
    EXPECT_EQ(picture->at(16 + 4, 26 + column, 1), tile.at(4, column, 1)) << "the fifth tile";
  }
  EXPECT_EQ(picture->at(20, 60), 255) << "there is no sixth";
}

TEST(ContactSheet, WithWordsIsLarger) {
  ContactSheet sheet = plain_sheet(2, 2);
  sheet.tiles[1].note = "3 objects";
  const auto captioned = draw_sheet(sheet);
  ASSERT_TRUE(captioned);
  EXPECT_GT(captioned->height, draw_sheet(plain_sheet(2, 2))->height);
  sheet.title = "parts";
  EXPECT_GT(draw_sheet(sheet)->height, captioned->height);
}

TEST(ContactSheet, BreaksItsLegendIntoRows) {
  ContactSheet sheet = plain_sheet(4, 4);
  sheet.legend = {{LegendEntry::Sign::kSwatch, class_color(1), "gear"}};
  const int one_row = draw_sheet(sheet)->height;
  LegendEntry entry;
  entry.text = "a class with a name that is far too long for its picture";
  for (int i = 2; i < 30; ++i) {
    entry.sign = static_cast<LegendEntry::Sign>(i % 5);
    sheet.legend.push_back(entry);
  }
  const auto many = draw_sheet(sheet);
  ASSERT_TRUE(many);
  EXPECT_EQ(many->height, one_row + 28 * 20);
  EXPECT_EQ(many->width, draw_sheet(plain_sheet(4, 4))->width + 2 * 12);
}

TEST(ContactSheet, ThatIsTooLargeSaysWhatToDo) {
  EXPECT_THAT(message_of(draw_sheet(plain_sheet(2000, 2000))), HasSubstr("--tile-width"));
  EXPECT_THAT(message_of(draw_sheet(ContactSheet{})), HasSubstr("no frame"));
}

TEST(ContactSheet, IsDrawnTheSameAgain) {
  ContactSheet sheet = plain_sheet(3, 2);
  sheet.title = "parts";
  sheet.legend = {{LegendEntry::Sign::kDepth, {}, "near to far"}};
  EXPECT_EQ(draw_sheet(sheet)->values, draw_sheet(sheet)->values);
}

TEST(Legend, HasTheClassesThatAreSeenAndTheSignsThatAreDrawn) {
  SeenLabels seen;
  FrameContent content = small_content();
  content.labels.instances[2].area_px = 0;  // the bolt
  seen.add(content.labels);
  const auto of = [&](const std::vector<LayerSet>& tiles) { return texts(seen.legend_for(tiles)); };
  EXPECT_EQ(of({{Layer::kImage}}), std::vector<std::string>{});
  EXPECT_EQ(of({{Layer::kImage, Layer::kBoxes}}), std::vector<std::string>{"gear"});
  EXPECT_EQ(of({{Layer::kImage}, {Layer::kInstances}}),
            (std::vector<std::string>{"gear", "without a class"}));
  EXPECT_EQ(of({{Layer::kSemantic}}), std::vector<std::string>{"gear"});
  EXPECT_EQ(of({{Layer::kKeypoints}}), std::vector<std::string>{"gear"}) << "nobody has any";
  EXPECT_EQ(of({{Layer::kDepth}}).size(), 1U);
  EXPECT_EQ(of({{Layer::kDisagreement}}).size(), 3U);
}

TEST(ColumnsFor, FillRowsOfTheShapeOfAScreen) {
  EXPECT_EQ(columns_for(1, 320, 240), 1);
  EXPECT_EQ(columns_for(12, 320, 240), 4);
  EXPECT_EQ(columns_for(6, 640, 480), 3);
  EXPECT_EQ(columns_for(8, 320, 240), 4);
  for (int count = 1; count < 40; ++count) {
    EXPECT_LE(columns_for(count, 100, 2000), count);
    EXPECT_GE(columns_for(count, 2000, 100), 1);
  }
}

}  // namespace
}  // namespace seedframe
