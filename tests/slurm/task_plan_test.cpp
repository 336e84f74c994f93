#include "slurm/task_plan.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TaskTimes times(double startup_s, double frame_s, int workers) {
  TaskTimes times;
  times.add_startup(startup_s);
  for (int i = 0; i < 20; ++i) times.add_frame(frame_s, workers);
  return times;
}

TEST(TaskPlan, FirstTasksAreSmall) {
  const TaskTimes none;
  EXPECT_FALSE(none.known());
  EXPECT_EQ(frames_of_task({10'000, 4}, none), 8);
  EXPECT_EQ(frames_of_task({10, 4}, none), 3) << "all of them have something to do";
  EXPECT_EQ(frames_of_task({1, 4}, none), 1);
}

TEST(TaskPlan, StartingIsASmallShare) {
  for (const double startup_s : {0.5, 10.0, 60.0}) {
    for (const double frame_s : {0.05, 2.0, 100.0}) {
      const std::int64_t frames = frames_of_task({1'000'000, 4}, times(startup_s, frame_s, 4));
      const double work_s = static_cast<double>(frames) * frame_s / 4;
      EXPECT_LE(startup_s / (startup_s + work_s), kMostStartupShare + 1e-9);
      const double less_s = static_cast<double>(frames - 1) * frame_s / 4;
      EXPECT_GT(startup_s / (startup_s + less_s), kMostStartupShare) << "no longer than that needs";
    }
  }
}

TEST(TaskPlan, NoTaskTakesTheWorkOfOthers) {
  EXPECT_EQ(frames_of_task({100, 10}, times(10, 0.1, 1)), 10);
  EXPECT_EQ(frames_of_task({101, 10}, times(10, 0.1, 1)), 11);
}

TEST(TaskPlan, TasksFitIntoTheirTime) {
  const TaskTimes slow = times(100, 60, 1);
  // 3600 s less twice the start and the time to stop, in frames of 90 s with the margin.
  EXPECT_EQ(frames_of_task({1000, 1, 3600}, slow), 36);
  EXPECT_EQ(frames_of_task({1000, 1, 250}, slow), 1) << "at least one, whatever was asked";
  EXPECT_EQ(time_of_task(36, {1000, 1, 7200}, slow), 320 + 36 * 90);
  EXPECT_EQ(time_of_task(36, {1000, 1, 1800}, slow), 1800) << "not beyond what was given";
  EXPECT_EQ(time_of_task(1, {1000, 1}, times(1, 0.1, 1)), 300) << "no task is that short";
  EXPECT_EQ(time_of_task(8, {1000, 1}, TaskTimes()), 0) << "the partition's";
}

TEST(TaskPlan, ShortTasksAreNotToldToStopAtOnce) {
  EXPECT_EQ(stop_signal_s(0), 120);
  EXPECT_EQ(stop_signal_s(3600), 120);
  EXPECT_EQ(stop_signal_s(60), 12);
  EXPECT_EQ(stop_signal_s(1), 1);
}

TEST(TaskPlan, SlowFramesDecideOverTime) {
  TaskTimes mixed;
  mixed.add_startup(1);
  for (int i = 0; i < 90; ++i) mixed.add_frame(1, 1);
  for (int i = 0; i < 10; ++i) mixed.add_frame(30, 1);
  EXPECT_DOUBLE_EQ(mixed.p95_frame_s(), 30);
  EXPECT_DOUBLE_EQ(mixed.mean_frame_s(), 3.9);
}

TEST(TaskPlan, WhatIsAskedForIsDone) {
  EXPECT_EQ(frames_of_task({1000, 4, 60, 17}, times(10, 60, 1)), 17);
}

}  // namespace
}  // namespace seedframe
