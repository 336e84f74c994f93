#include "page/near_duplicates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/page/table_cases.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Signatures = std::vector<std::optional<PictureSignature>>;

PictureSignature grey(std::uint8_t value) {
  PictureSignature signature;
  signature.fill(value);
  return signature;
}

TEST(NearDuplicates, AreFramesWithTheSameBoxesAndColours) {
  FrameTable table;
  add_frame(table, {{.x = 10}, {.category = 2, .x = 50}});
  add_frame(table, {{.x = 200}, {.category = 2, .x = 50}});
  add_frame(table, {{.category = 2, .x = 51}, {.x = 11}});  // whatever the order
  const Signatures signatures = {grey(100), grey(100), grey(102)};
  EXPECT_THAT(near_duplicates(table, signatures, 320), ElementsAre(ElementsAre(0u, 2u)));
}

TEST(NearDuplicates, AreNoneInOtherColours) {
  FrameTable table;
  add_frame(table, {{.x = 10}});
  add_frame(table, {{.x = 10}});
  EXPECT_THAT(near_duplicates(table, {grey(100), grey(110)}, 320), IsEmpty());
}

TEST(NearDuplicates, AreNoneWithAnotherClassOrNumber) {
  FrameTable table;
  add_frame(table, {{.category = 1}});
  add_frame(table, {{.category = 2}});
  add_frame(table, {{.category = 1}, {.category = 1}});
  EXPECT_THAT(near_duplicates(table, Signatures(3), 320), IsEmpty());
}

TEST(NearDuplicates, ReachFromOneToTheNext) {
  FrameTable table;
  for (const int x : {10, 13, 16, 40}) add_frame(table, {{.x = x}});
  EXPECT_THAT(near_duplicates(table, Signatures(4), 320), ElementsAre(ElementsAre(0u, 1u, 2u)));
}

TEST(NearDuplicates, DistractorsAndFramesThatAreNotDoneDoNotCount) {
  FrameTable table;
  add_frame(table, {{.x = 10}, {.category = 0, .x = 90}});
  add_frame(table, {{.x = 10}, {.category = 0, .x = 200}});
  add_frame(table, {{.x = 10}}, ShownState::kDamaged);
  EXPECT_THAT(near_duplicates(table, Signatures(3), 320), ElementsAre(ElementsAre(0u, 1u)));
}

TEST(NearDuplicates, OfFramesThatShowNothingAreToldByPictures) {
  FrameTable table;
  for (int i = 0; i < 3; ++i) add_frame(table, {});
  EXPECT_THAT(near_duplicates(table, {grey(40), grey(90), grey(41)}, 320),
              ElementsAre(ElementsAre(0u, 2u)));
  EXPECT_THAT(near_duplicates(table, Signatures(3), 320), IsEmpty()) << "nothing tells them apart";
}

TEST(NearDuplicates, OfAnEmptyCampaignAreNone) {
  EXPECT_THAT(near_duplicates(FrameTable(), {}, 320), IsEmpty());
}

}  // namespace
}  // namespace seedframe
