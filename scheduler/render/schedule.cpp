#include "render/schedule.h"

#include <algorithm>

namespace seedframe {

Schedule::Schedule(const std::vector<PendingFrame>& frames, int max_attempts)
    : max_attempts_(max_attempts) {
  for (const PendingFrame& frame : frames) {
    frames_.push_back({frame.frame, frame.attempts_used + 1});
    if (frame.attempts_used > 0) used_before_[frame.frame] = frame.attempts_used;
  }
}

std::optional<FrameJob> Schedule::next(bool fresh_worker) {
  if (draining_) return std::nullopt;
  std::deque<FrameJob>& queue = fresh_worker && !fresh_.empty() ? fresh_ : frames_;
  if (queue.empty()) return std::nullopt;
  const FrameJob job = queue.front();
  queue.pop_front();
  open_.emplace(job, State::kHandedOut);
  return job;
}

bool Schedule::is_last_attempt(const FrameJob& job) const {
  const auto before = used_before_.find(job.frame);
  return job.attempt >= max_attempts_ + (before == used_before_.end() ? 0 : before->second);
}

bool Schedule::withdraw(const FrameJob& job) {
  if (!is(job, State::kHandedOut)) return false;
  open_.erase(job);
  frames_.push_front(job);
  return true;
}

bool Schedule::rendered(const FrameJob& job) {
  if (!is(job, State::kHandedOut)) return false;
  open_[job] = State::kUnjudged;
  return true;
}

bool Schedule::committed(const FrameJob& job) {
  if (!is(job, State::kUnjudged)) return false;
  open_.erase(job);
  ++done_;
  return true;
}

bool Schedule::attempt_failed(const FrameJob& job, RetryIn where) {
  if (is_last_attempt(job)) return fail_for_good(job);
  if (open_.erase(job) == 0) return false;
  std::deque<FrameJob>& queue = where == RetryIn::kFreshWorker ? fresh_ : frames_;
  queue.push_back({job.frame, job.attempt + 1});
  return true;
}

bool Schedule::fail_for_good(const FrameJob& job) {
  if (open_.erase(job) == 0) return false;
  ++failed_;
  return true;
}

std::int64_t Schedule::waiting() const {
  return static_cast<std::int64_t>(frames_.size() + fresh_.size());
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
