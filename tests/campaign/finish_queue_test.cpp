#include "campaign/finish_queue.h"

#include <atomic>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(FinishQueue, TheDestructorWaitsForAllJobs) {
  std::atomic<int> done = 0;
  {
    FinishQueue queue(2);
    for (int i = 0; i < 500; ++i) queue.push([&done] { ++done; });
  }
  EXPECT_EQ(done, 500);
}

}  // namespace
}  // namespace seedframe
