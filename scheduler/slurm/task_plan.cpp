#include "slurm/task_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace seedframe {
namespace {

constexpr std::size_t kKeptTimes = 2000;
constexpr std::size_t kEnoughFrames = 3;
constexpr std::int64_t kPilotFrames = 8;
constexpr double kMargin = 1.5;
constexpr double kShortestTask = 300.0;  // seconds, and

constexpr int kStopSignal = 120;

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

void TaskTimes::add_startup(double seconds) { startups_.push_back(seconds); }

void TaskTimes::add_frame(double seconds, int workers) {
  const double each = seconds / std::max(1, workers);
  if (frames_.size() < kKeptTimes) {
    frames_.push_back(each);
  } else {
    frames_[next_++ % kKeptTimes] = each;
  }
}

bool TaskTimes::known() const { return !startups_.empty() && frames_.size() >= kEnoughFrames; }

double TaskTimes::startup_s() const { return mean(startups_); }

double TaskTimes::mean_frame_s() const { return mean(frames_); }

double TaskTimes::p95_frame_s() const {
  if (frames_.empty()) return 0.0;
  std::vector<double> sorted = frames_;
  const auto at =
      static_cast<std::size_t>(std::lround(0.95 * static_cast<double>(sorted.size() - 1)));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(at), sorted.end());
  return sorted[at];
}

int stop_signal_s(double time_s) {
  constexpr double kMostOfTime = 0.2;  // of a short task: it is to make something before
  if (time_s <= 0.0) return kStopSignal;
  return std::clamp(static_cast<int>(kMostOfTime * time_s), 1, kStopSignal);
}

std::int64_t frames_of_task(const TaskPlanWish& wish, const TaskTimes& times) {
  if (wish.batch_frames > 0) return wish.batch_frames;
  const std::int64_t share =
      (wish.frames + wish.tasks_at_once - 1) / std::max(1, wish.tasks_at_once);
  if (!times.known()) return std::clamp<std::int64_t>(share, 1, kPilotFrames);
  const double frame_s = std::max(times.mean_frame_s(), 1e-6);
  const double worth_starting =
      std::ceil(times.startup_s() * (1.0 / kMostStartupShare - 1.0) / frame_s);
  double most = std::min(worth_starting, static_cast<double>(share));
  if (wish.time_s > 0) {
    const auto time_s = static_cast<double>(wish.time_s);
    const double left = time_s - 2.0 * times.startup_s() - stop_signal_s(time_s);
    most = std::min(most, std::floor(left / (kMargin * std::max(times.p95_frame_s(), 1e-6))));
  }
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(most));
}

double time_of_task(std::int64_t frames, const TaskPlanWish& wish, const TaskTimes& times) {
  const auto most = static_cast<double>(wish.time_s);
  if (!times.known()) return most;
  const double needed =
      std::max(kShortestTask, 2.0 * times.startup_s() + kStopSignal +
                                  kMargin * times.p95_frame_s() * static_cast<double>(frames));
  return wish.time_s > 0 ? std::min(most, needed) : needed;
}

}  // namespace seedframe
