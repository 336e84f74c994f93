#include "render/schedule.h"

#include <algorithm>

namespace seedframe {

Schedule::Schedule(const std::vector<PendingFrame>& frames, const AttemptLimits& limits)
    : limits_(limits) {
  for (const PendingFrame& frame : frames) add(frame);
}

void Schedule::add(const PendingFrame& frame) {
  if (frame.crashes > 0) charges_[frame.frame].crashes = frame.crashes;
  std::deque<FrameJob>& queue = frame.crashes > 0 ? queue_after_crash(frame.frame) : frames_;
  queue.push_back({frame.frame, frame.attempts_used + 1});
}

std::optional<FrameJob> Schedule::next(bool fresh_worker) {
  if (draining_ || runs_alone_) return std::nullopt;
  std::deque<FrameJob>* queue = &frames_;
  if (fresh_worker && !fresh_.empty()) queue = &fresh_;
  const bool alone = queue->empty() && fresh_worker && can_run_alone();
  if (alone) queue = &alone_;
  if (queue->empty()) return std::nullopt;
  const FrameJob job = queue->front();
  queue->pop_front();
  open_.emplace(job, State::kHandedOut);
  if (alone) runs_alone_ = job;
  return job;
}

bool Schedule::withdraw(const FrameJob& job) {
  if (!is(job, State::kHandedOut)) return false;
  left_worker(job);
  open_.erase(job);
  std::deque<FrameJob>& queue = crashes(job.frame) > 0 ? queue_after_crash(job.frame) : frames_;
  queue.push_front(job);
  return true;
}

bool Schedule::rendered(const FrameJob& job) {
  if (!is(job, State::kHandedOut)) return false;
  left_worker(job);
  open_[job] = State::kUnjudged;
  return true;
}

bool Schedule::committed(const FrameJob& job) {
  if (!is(job, State::kUnjudged)) return false;
  open_.erase(job);
  ++done_;
  return true;
}

std::optional<Consequence> Schedule::attempt_failed(const FrameJob& job, Failure failure) {
  if (open_.erase(job) == 0) return std::nullopt;
  left_worker(job);
  Charges& charges = charges_[job.frame];
  if (failure == Failure::kCrash) {
    if (++charges.crashes >= limits_.crashes) {
      ++quarantined_;
      return Consequence::kQuarantined;
    }
    queue_after_crash(job.frame).push_back({job.frame, job.attempt + 1});
    return Consequence::kRetry;
  }
  if (++charges.errors >= limits_.errors) {
    ++failed_;
    return Consequence::kFailed;
  }
  const FrameJob again = {job.frame, job.attempt + 1};
  if (failure == Failure::kAnswered) {
    frames_.push_back(again);
  } else if (charges.errors + 1 >= limits_.errors) {
    fresh_.push_back(again);
  } else {
    frames_.push_front(again);  // the worker that wrote the bad file is replaced: anybody else may
  }
  return Consequence::kRetry;
}

bool Schedule::fail_for_good(const FrameJob& job) {
  if (open_.erase(job) == 0) return false;
  left_worker(job);
  ++failed_;
  return true;
}

bool Schedule::wants_fresh_worker() const {
  return !draining_ && frames_.empty() && (!fresh_.empty() || can_run_alone());
}

std::int64_t Schedule::workers_wanted() const {
  if (draining_ || runs_alone_) return 0;
  if (frames_.empty() && fresh_.empty()) return can_run_alone() ? 1 : 0;
  return static_cast<std::int64_t>(frames_.size() + fresh_.size());
}

int Schedule::crashes(std::int64_t frame) const {
  const auto found = charges_.find(frame);
  return found == charges_.end() ? 0 : found->second.crashes;
}

std::int64_t Schedule::waiting() const {
  return static_cast<std::int64_t>(frames_.size() + fresh_.size() + alone_.size());
}

std::deque<FrameJob>& Schedule::queue_after_crash(std::int64_t frame) {
  return crashes(frame) + 1 >= limits_.crashes ? alone_ : fresh_;
}

bool Schedule::can_run_alone() const {
  return !runs_alone_ && !alone_.empty() && frames_.empty() && fresh_.empty() && handed_out() == 0;
}

void Schedule::left_worker(const FrameJob& job) {
  if (runs_alone_ == job) runs_alone_.reset();
}

bool Schedule::is(const FrameJob& job, State state) const {
  const auto found = open_.find(job);
  return found != open_.end() && found->second == state;
}

std::int64_t Schedule::count(State state) const {
  return std::count_if(open_.begin(), open_.end(),
                       [state](const auto& entry) { return entry.second == state; });
}

}  // namespace seedframe
