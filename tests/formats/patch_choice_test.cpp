#include "formats/patch_choice.h"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<SplitShare> kThreeSplits = {{"train", 0.7}, {"val", 0.2}, {"test", 0.1}};

PatchDemand demand_for(int per_class, std::vector<int> categories,
                       std::vector<SplitShare> splits = {{"train", 1.0}}) {
  return {.per_class = per_class,
          .splits = std::move(splits),
          .categories = std::move(categories),
          .class_names = {"robot", "ball"},
          .frames = 100,
          .campaign = "spl"};
}

/// `count` patches of a class in each of the frames from `first` to before `end`.
void add(std::vector<PatchCandidate>& candidates, int category, std::int64_t first,
         std::int64_t end, int count, int split = 0) {
  for (std::int64_t frame = first; frame < end; ++frame) {
    for (int number = 1; number <= count; ++number) {
      const auto draw = static_cast<std::uint64_t>(frame * 7919 + number * 104729) % 1000003;
      candidates.push_back({frame, split, category, number, draw});
    }
  }
}

int chosen_of(const std::map<std::int64_t, ChosenPatches>& chosen, int category) {
  int count = 0;
  for (const auto& [frame, patches] : chosen) {
    for (const auto& [of, number] : patches) count += of == category;
  }
  return count;
}

TEST(PatchChoice, SharesOfSplitsAddUpToTheNumber) {
  EXPECT_THAT(patches_of_splits(25000, kThreeSplits), ElementsAre(17500, 5000, 2500));
  for (int number = 1; number < 50; ++number) {
    const std::vector<int> wanted = patches_of_splits(number, kThreeSplits);
    EXPECT_EQ(wanted[0] + wanted[1] + wanted[2], number);
    for (const int each : wanted) EXPECT_GE(each, 0);
  }
}

TEST(PatchChoice, TakesExactlySoManyOfEveryClassAndSplit) {
  std::vector<PatchCandidate> candidates;
  add(candidates, 1, 0, 70, 9);
  add(candidates, 2, 0, 70, 1);
  add(candidates, 1, 70, 100, 9, 1);
  add(candidates, 2, 70, 100, 1, 1);
  const auto chosen =
      choose_patches(candidates, demand_for(60, {1, 2}, {{"train", 0.75}, {"val", 0.25}}));
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_EQ(chosen_of(*chosen, 1), 60);
  EXPECT_EQ(chosen_of(*chosen, 2), 60);
  std::map<std::int64_t, ChosenPatches> val(chosen->lower_bound(70), chosen->end());
  EXPECT_EQ(chosen_of(val, 1), 15);
  EXPECT_EQ(chosen_of(val, 2), 15);
}

TEST(PatchChoice, ComesFromAsManyFramesAsThereAre) {
  std::vector<PatchCandidate> candidates;
  add(candidates, 1, 0, 100, 9);
  const auto hundred = choose_patches(candidates, demand_for(100, {1}));
  ASSERT_TRUE(hundred);
  EXPECT_EQ(hundred->size(), 100U);
  const auto more = choose_patches(candidates, demand_for(130, {1}));
  ASSERT_TRUE(more);
  EXPECT_EQ(more->size(), 100U);
  for (const auto& [frame, patches] : *more) EXPECT_LE(patches.size(), 2U);
}

TEST(PatchChoice, DoesNotDependOnTheOrderInWhichPatchesAreFound) {
  std::vector<PatchCandidate> candidates;
  add(candidates, 1, 0, 40, 3);
  const auto chosen = choose_patches(candidates, demand_for(50, {1}));
  std::reverse(candidates.begin(), candidates.end());
  EXPECT_EQ(*choose_patches(candidates, demand_for(50, {1})), *chosen);
}

TEST(PatchChoice, AFewerPatchesAreAmongTheMore) {
  std::vector<PatchCandidate> candidates;
  add(candidates, 1, 0, 40, 3);
  const auto few = choose_patches(candidates, demand_for(20, {1}));
  const auto many = choose_patches(candidates, demand_for(90, {1}));
  for (const auto& [frame, patches] : *few) {
    for (const auto& each : patches) {
      ASSERT_TRUE(many->count(frame));
      EXPECT_THAT(many->at(frame), ::testing::Contains(each));
    }
  }
}

TEST(PatchChoice, SaysWhatIsMissingAndHowManyFramesWouldHaveIt) {
  std::vector<PatchCandidate> candidates;
  add(candidates, 1, 0, 100, 2);
  add(candidates, 2, 0, 40, 1);
  const auto chosen = choose_patches(candidates, demand_for(80, {1, 2}));
  ASSERT_FALSE(chosen);
  EXPECT_EQ(chosen.error().kind, ErrorKind::kInput);
  const std::string& message = chosen.error().message;
  EXPECT_THAT(message, HasSubstr("--per-class 80: the 100 frames have too few patches of"));
  EXPECT_THAT(message, HasSubstr("ball: 40 of 80"));
  EXPECT_THAT(message, Not(HasSubstr("robot")));
  EXPECT_THAT(message, HasSubstr("about 220 frames should have them, 120 more"));
}

TEST(PatchChoice, AClassThatNoFrameHasIsNotAskedOfMoreFrames) {
  std::vector<PatchCandidate> candidates;
  add(candidates, 1, 0, 100, 2);
  const auto chosen = choose_patches(candidates, demand_for(80, {1, 2}));
  ASSERT_FALSE(chosen);
  EXPECT_THAT(chosen.error().message, HasSubstr("no frame that is there has a patch of 'ball'"));
  EXPECT_THAT(chosen.error().message, Not(HasSubstr("more than campaign")));
}

TEST(PatchChoice, ASplitWithoutAClassIsNamed) {
  std::vector<PatchCandidate> candidates;
  add(candidates, 1, 0, 90, 1);
  const auto chosen =
      choose_patches(candidates, demand_for(50, {1}, {{"train", 0.8}, {"val", 0.2}}));
  ASSERT_FALSE(chosen);
  EXPECT_THAT(chosen.error().message, HasSubstr("robot: 0 of 10 in val"));
  EXPECT_THAT(chosen.error().message, HasSubstr("frames should have them"));
}

}  // namespace
}  // namespace seedframe
