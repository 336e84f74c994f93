#include "plan/worker_plan.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

constexpr std::int64_t kMany = 1000;

void expect_plan(const WorkerPlan& plan, int workers, int threads) {
  EXPECT_EQ(plan.workers, workers);
  EXPECT_EQ(plan.threads, threads);
}

TEST(WorkerPlan, SmallFramesGetAWorkerPerCore) {
  expect_plan(choose_workers(128, 128, 1, kMany, 2), 2, 1);
  expect_plan(choose_workers(128, 128, 4, kMany, 16), 16, 1);
}

TEST(WorkerPlan, LargeFramesGetAllCores) {
  expect_plan(choose_workers(640, 480, 16, kMany, 2), 1, 2);
  expect_plan(choose_workers(1920, 1080, 128, kMany, 32), 1, 32);
}

TEST(WorkerPlan, InBetweenIsInBetween) {
  expect_plan(choose_workers(128, 128, 16, kMany, 8), 4, 2);
  expect_plan(choose_workers(320, 240, 16, kMany, 16), 3, 5);
}

TEST(WorkerPlan, FewFramesShareTheCores) {
  expect_plan(choose_workers(128, 128, 1, 1, 8), 1, 8);
  expect_plan(choose_workers(128, 128, 1, 3, 8), 3, 2);
}

TEST(WorkerPlan, AlwaysUsesOneToAllCores) {
  for (int cores = -1; cores <= 130; ++cores) {
    for (const std::int64_t frames : {std::int64_t{0}, std::int64_t{7}, kMany}) {
      for (int side = 1; side <= 16384; side *= 4) {
        for (const int samples : {0, 1, 64, 1 << 24}) {
          const WorkerPlan plan = choose_workers(side, side, samples, frames, cores);
          ASSERT_GE(plan.workers, 1);
          ASSERT_GE(plan.threads, 1);
          ASSERT_LE(plan.workers * plan.threads, std::max(1, cores));
        }
      }
    }
  }
}

}  // namespace
}  // namespace seedframe
