#include "export/split.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

int val_scenes(double share, std::uint64_t seed, int scenes) {
  int val = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    val += split_of_scene(scene, {.output = {}, .val_share = share, .seed = seed}) == Split::kVal;
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
      return split_of_scene(scene, {.output = {}, .val_share = share, .seed = 3});
    };
    if (split(0.2) == Split::kVal) {
      EXPECT_EQ(split(0.3), Split::kVal);
    }
  }
}

// The draws are part of what a dataset is: a release that moved a scene would leak training images
// into the validation of whoever exports again.
TEST(Split, IsPinned) {
  std::string splits;
  for (int scene = 0; scene < 24; ++scene) {
    const Split split = split_of_scene(scene, {.output = {}, .val_share = 0.25, .seed = 7});
    splits += split == Split::kVal ? 'v' : 't';
  }
  EXPECT_EQ(splits, "vtttvttttttttvvtttvttttt");
}

}  // namespace
}  // namespace seedframe
