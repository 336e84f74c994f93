#include "export/split.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

int val_scenes(double share, std::uint64_t seed, int scenes) {
  int val = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    val += split_of_scene(scene, seed, {{"train", 1.0 - share}, {"val", share}});
  }
  return val;
}

TEST(Split, EverythingTrainsWithoutAShare) { EXPECT_EQ(val_scenes(0.0, 1, 1000), 0); }

TEST(Split, FollowsTheShare) {
  // Five standard deviations of a binomial distribution.
  EXPECT_NEAR(val_scenes(0.2, 1, 10000), 2000, 200);
  EXPECT_NEAR(val_scenes(0.9, 1, 10000), 9000, 150);
}

TEST(Split, ALargerShareOnlyAddsScenes) {
  for (int scene = 0; scene < 1000; ++scene) {
    const auto split = [scene](double share) {
      return split_of_scene(scene, 3, {{"train", 1.0 - share}, {"val", share}});
    };
    if (split(0.2) == 1) {
      EXPECT_EQ(split(0.3), 1);
    }
  }
}

// The draws are part of what a dataset is: a release that moved a scene would leak training images
// into the validation of whoever exports again.
TEST(Split, IsPinned) {
  std::string splits;
  for (int scene = 0; scene < 24; ++scene) {
    const int split = split_of_scene(scene, 7, {{"train", 0.75}, {"val", 0.25}});
    splits += split == 1 ? 'v' : 't';
  }
  EXPECT_EQ(splits, "vtttvttttttttvvtttvttttt");
}

TEST(Split, ATestShareTakesNothingFromVal) {
  int test = 0;
  for (int scene = 0; scene < 1000; ++scene) {
    const int two = split_of_scene(scene, 3, {{"train", 0.8}, {"val", 0.2}});
    const int three = split_of_scene(scene, 3, {{"train", 0.7}, {"val", 0.2}, {"test", 0.1}});
    EXPECT_EQ(two == 1, three == 1);
    test += three == 2;
  }
  EXPECT_NEAR(test, 100, 48);  // five standard deviations
}

}  // namespace
}  // namespace seedframe
