// How many frames an array task is given, and how long it may take: pure arithmetic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace seedframe {

/// What tasks have taken so far.
class TaskTimes {
 public:
  /// Of a task, from its start to its first frame, seconds.
  void add_startup(double seconds);
  /// Of a frame, of a task with so many workers: what one of them was busy with it, seconds.
  void add_frame(double seconds, int workers);

  /// Whether there is enough to plan by.
  bool known() const;
  double startup_s() const;  ///< the mean
  /// From one frame of a task to the next.
  double mean_frame_s() const;
  double p95_frame_s() const;

 private:
  std::vector<double> startups_;
  std::vector<double> frames_;  ///< the newest
  std::size_t next_ = 0;
};

struct TaskPlanWish {
  std::int64_t frames = 0;  ///< that are to be given out
  int tasks_at_once = 1;    ///< that the cluster can run
  std::int64_t time_s = 0;  ///< most time of a task; 0: not known
  int batch_frames = 0;     ///< asked for; 0: to be chosen
};

/// Start-up is to take this share of a task's time at most.
inline constexpr double kMostStartupShare = 0.02;
/// Seconds before the end of its time (0: not known) at which Slurm tells a task to stop.
int stop_signal_s(double time_s);

/// Frames of a task. Without times: a few, to measure them. With: so many that starting is
/// kMostStartupShare of the task's time, but no more than leave work for all tasks that can run at
/// once, and no more than fit into the time of a task, told by the 95th percentile with a margin.
std::int64_t frames_of_task(const TaskPlanWish& wish, const TaskTimes& times);

/// The time that a task of so many frames asks for, seconds; 0: its partition's. Frames as slow as
/// the 95th percentile, half as much again, and time to stop; not beyond wish.time_s.
double time_of_task(std::int64_t frames, const TaskPlanWish& wish, const TaskTimes& times);

}  // namespace seedframe
