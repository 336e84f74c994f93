#include "quality/error_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::int64_t> frames_up_to(std::int64_t count) {
  std::vector<std::int64_t> frames;
  for (std::int64_t i = 0; i < count; ++i) frames.push_back(10 * i);
  return frames;
}

TEST(StratifiedSample, HasOneFrameOfEachPart) {
  const std::vector<std::int64_t> done = frames_up_to(100);
  const std::vector<std::int64_t> sample = stratified_sample(done, 7, 3);
  ASSERT_EQ(sample.size(), 7u);
  for (std::int64_t i = 0; i < 7; ++i) {
    EXPECT_GE(sample[static_cast<std::size_t>(i)], 10 * (i * 100 / 7));
    EXPECT_LT(sample[static_cast<std::size_t>(i)], 10 * ((i + 1) * 100 / 7));
  }
  EXPECT_EQ(stratified_sample(done, 7, 3), sample);
  EXPECT_NE(stratified_sample(done, 7, 4), sample);
}

TEST(StratifiedSample, IsAllWhenMoreAreAskedFor) {
  EXPECT_THAT(stratified_sample({3, 5}, 2, 0), ElementsAre(3, 5));
  EXPECT_THAT(stratified_sample({3, 5}, 9, 0), ElementsAre(3, 5));
  EXPECT_THAT(stratified_sample({}, 9, 0), IsEmpty());
}

}  // namespace
}  // namespace seedframe
