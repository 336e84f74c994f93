#include "render/frame_timeout.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

using namespace std::chrono_literals;

TEST(FrameTimeout, IsTheLongestUntilSomeFramesAreKnown) {
  FrameTimeout timeout(600s);
  EXPECT_EQ(timeout.limit(0), 600s);
  for (int i = 0; i < 7; ++i) timeout.rendered(1s);
  EXPECT_EQ(timeout.limit(0), 600s);
  timeout.rendered(5s);
  EXPECT_EQ(timeout.limit(0), 50s) << "ten times the longest";
}

TEST(FrameTimeout, HasAFloorAndACeiling) {
  FrameTimeout timeout(600s);
  for (int i = 0; i < 8; ++i) timeout.rendered(10ms);
  EXPECT_EQ(timeout.limit(0), 30s);
  timeout.rendered(100s);
  EXPECT_EQ(timeout.limit(0), 600s);
}

TEST(FrameTimeout, ForgetsWhatIsLongAgo) {
  FrameTimeout timeout(600s);
  timeout.rendered(50s);
  for (int i = 0; i < 100; ++i) timeout.rendered(10ms);
  EXPECT_EQ(timeout.limit(0), 30s);
}

TEST(FrameTimeout, ASuspectGetsMoreTime) {
  FrameTimeout timeout(600s);
  for (int i = 0; i < 8; ++i) timeout.rendered(4s);
  EXPECT_EQ(timeout.limit(0), 40s);
  EXPECT_EQ(timeout.limit(1), 160s);
  EXPECT_EQ(timeout.limit(2), 600s);
}

}  // namespace
}  // namespace seedframe
