#include "campaign/finish_queue.h"

#include <algorithm>
#include <atomic>
#include <latch>
#include <memory>
#include <vector>

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

TEST(FinishQueue, RunsAsManyJobsAtOnceAsItHasThreads) {
  std::atomic<int> at_once = 0;
  std::atomic<int> most = 0;
  std::latch all_run(3);
  {
    FinishQueue queue(3);
    for (int i = 0; i < 12; ++i) {
      queue.push([&, i] {
        const int now = ++at_once;
        for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
        }
        if (i < 3) all_run.arrive_and_wait();  // for ever, unless three run at once
        --at_once;
      });
    }
  }
  EXPECT_EQ(most, 3);
}

TEST(FinishQueue, OneThreadTakesJobsInTheirOrder) {
  std::vector<int> order;
  {
    FinishQueue queue(1);
    for (int i = 0; i < 100; ++i) queue.push([&order, i] { order.push_back(i); });
  }
  EXPECT_EQ(order.size(), 100U);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(FinishQueue, LetsGoOfWhatAJobHeldOnceItIsDone) {
  FinishQueue queue(1);
  auto held = std::make_shared<int>(7);
  const std::weak_ptr<int> watched = held;
  queue.push([held = std::move(held)] {});
  std::latch next(1);
  queue.push([&next] { next.count_down(); });
  next.wait();
  EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace seedframe
