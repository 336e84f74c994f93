#include "page/health.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/page/table_cases.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Judged = HealthFinding::Level;

/// 30 good frames of two classes, to which each test adds what is wrong.
class HealthTest : public ::testing::Test {
 protected:
  HealthTest() {
    for (int i = 0; i < 30; ++i) add_frame(table_, {{.x = 5 * i}, {.category = 2, .x = 3 * i}});
  }

  std::vector<HealthFinding> findings() const {
    return check_health({table_, categories_, 320, has_pictures_, duplicates_, splits_});
  }
  /// The first of this check; an empty one if there is none.
  HealthFinding of(const std::string& check) const {
    for (const HealthFinding& finding : findings()) {
      if (finding.check == check) return finding;
    }
    return {};
  }

  FrameTable table_;
  std::vector<std::string> categories_ = {"bolt", "nut"};
  bool has_pictures_ = true;
  std::vector<std::vector<std::size_t>> duplicates_;
  std::vector<SplitScenes> splits_;
};

TEST_F(HealthTest, NothingIsWrongWithAGoodDataset) {
  for (const HealthFinding& finding : findings()) {
    EXPECT_EQ(finding.level, Judged::kGood) << finding.title;
    EXPECT_THAT(finding.frames, IsEmpty());
  }
  EXPECT_EQ(findings().size(), 6u);
}

TEST_F(HealthTest, AClassWithoutObjectsIsRare) {
  categories_.emplace_back("gear");
  const HealthFinding finding = of("rare-classes");
  EXPECT_EQ(finding.level, Judged::kWarning);
  EXPECT_EQ(finding.category, "gear");
  EXPECT_THAT(finding.text, HasSubstr("No frame shows"));
}

TEST_F(HealthTest, AClassFarBelowTheOthersIsRare) {
  categories_.emplace_back("gear");
  for (int i = 0; i < 22; ++i) add_frame(table_, {{.category = 3}});
  EXPECT_EQ(of("rare-classes").level, Judged::kGood) << "22, where the mean is 27";
  for (int i = 0; i < 300; ++i) add_frame(table_, {{.category = 1}, {.category = 2}});
  const HealthFinding finding = of("rare-classes");
  EXPECT_EQ(finding.category, "gear") << "22, where the mean is 227";
  ASSERT_EQ(finding.frames.size(), 22u);
  EXPECT_EQ(finding.frames.front(), 30);
}

TEST_F(HealthTest, ManyRareClassesAreToldTogether) {
  for (int k = 0; k < 80; ++k) categories_.push_back("class " + std::to_string(k));
  const auto all = findings();
  const auto rare = std::count_if(all.begin(), all.end(), [](const HealthFinding& finding) {
    return finding.check == "rare-classes";
  });
  EXPECT_EQ(rare, 6);
  EXPECT_THAT(all[5].title, HasSubstr("75 more"));
  EXPECT_THAT(all[5].text, HasSubstr("class 79"));
}

TEST_F(HealthTest, SmallBoxesAreToldOfTheirClass) {
  for (int i = 0; i < 3; ++i) add_frame(table_, {{.category = 2, .width = 30, .height = 7}});
  EXPECT_EQ(of("small-boxes").level, Judged::kGood) << "3 of 33";
  add_frame(table_, {{.category = 2, .width = 7, .height = 30}});
  const HealthFinding finding = of("small-boxes");
  EXPECT_EQ(finding.level, Judged::kWarning);
  EXPECT_EQ(finding.category, "nut");
  EXPECT_THAT(finding.text, HasSubstr("4 of its 34 boxes"));
  EXPECT_THAT(finding.frames, ElementsAre(30, 31, 32, 33));
}

TEST_F(HealthTest, ObjectsThatAreHardlyVisibleAreNoted) {
  for (int i = 0; i < 30; ++i) add_frame(table_, {{.visible_permille = 99}});
  EXPECT_EQ(of("hidden-objects").level, Judged::kNote) << "30 of 90";
  for (int i = 0; i < 40; ++i) add_frame(table_, {{.visible_permille = 100}});
  EXPECT_EQ(of("hidden-objects").level, Judged::kGood) << "30 of 130";
}

TEST_F(HealthTest, FramesThatShowNothingAreTold) {
  add_frame(table_, {{.category = 0}});
  add_frame(table_, {{.width = 0}});
  EXPECT_EQ(of("empty-frames").level, Judged::kNote);
  EXPECT_THAT(of("empty-frames").frames, ElementsAre(30, 31));
  add_frame(table_, {});
  add_frame(table_, {});
  EXPECT_EQ(of("empty-frames").level, Judged::kWarning) << "4 of 34";
}

TEST_F(HealthTest, BlackAndWhitePicturesAreTold) {
  add_frame(table_, {{}}, ShownState::kDone, 8);
  EXPECT_EQ(of("exposure").level, Judged::kWarning);
  EXPECT_THAT(of("exposure").frames, ElementsAre(30));
  has_pictures_ = false;
  EXPECT_EQ(of("exposure").check, "") << "there are no pictures to look at";
}

TEST_F(HealthTest, NearDuplicatesAreCounted) {
  duplicates_ = {{2, 3, 5}, {7, 9}};
  const HealthFinding finding = of("near-duplicates");
  EXPECT_EQ(finding.level, Judged::kWarning);
  EXPECT_EQ(finding.title, "3 near-duplicate frames");
  EXPECT_THAT(finding.text, HasSubstr("in 2 groups"));
  EXPECT_THAT(finding.frames, ElementsAre(2, 3, 5, 7, 9));
}

TEST_F(HealthTest, SplitsLeakIfTheyShareASceneOrDuplicates) {
  EXPECT_EQ(of("leaking-splits").check, "") << "there are no exports";
  splits_ = {{"coco", "train", {0, 1, 2}, {0}}, {"coco", "val", {3, 4, 5}, {1}}};
  EXPECT_EQ(of("leaking-splits").level, Judged::kGood);
  duplicates_ = {{0, 1}};
  EXPECT_EQ(of("leaking-splits").level, Judged::kGood) << "both are in train";
  duplicates_ = {{1, 4}};
  EXPECT_THAT(of("leaking-splits").text, HasSubstr("1 group of near-duplicates"));
  splits_[1].scenes = {0, 1};
  EXPECT_EQ(of("leaking-splits").level, Judged::kWarning);
  EXPECT_THAT(of("leaking-splits").text, HasSubstr("the first is scene 0"));
}

TEST_F(HealthTest, ExportsDoNotLeakIntoEachOther) {
  splits_ = {{"coco", "train", {0, 1, 2}, {0}}, {"voc", "val", {0, 1, 2}, {0}}};
  EXPECT_EQ(of("leaking-splits").level, Judged::kGood);
}

TEST(Health, OfNothingSaysNothing) {
  FrameTable none;
  EXPECT_THAT(check_health({none, {"bolt"}, 320, true, {}, {}}), IsEmpty());
  add_frame(none, {}, ShownState::kPending);
  EXPECT_THAT(check_health({none, {"bolt"}, 320, true, {}, {}}), IsEmpty());
}

}  // namespace
}  // namespace seedframe
