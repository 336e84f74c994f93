// Which frame next, and what became of each: the plan of a run, with no process, disk or clock.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "render/frame_job.h"

namespace seedframe {

/// What an attempt's failure says about the worker.
enum class RetryIn {
  kAnyWorker,    ///< it answered in good order that it cannot render the frame
  kFreshWorker,  ///< it died, hung, lied or wrote a bad file: something in it may be broken
};

/// Every frame is in one of these states, and every attempt is counted once:
///
///     waiting --next--> handed out --rendered--> unjudged --committed--> done
///        ^                  |                       |
///        |---- failed ------|-----------------------|---> failed for good (no attempts left)
///
/// Calls about a job that is not in the state that they ask for change nothing and return false, so
/// a late or repeated answer can do no harm.
class Schedule {
 public:
  /// Each frame gets max_attempts in this run, whatever earlier runs used: who resumes a campaign
  /// has mended something.
  Schedule(const std::vector<PendingFrame>& frames, int max_attempts);

  /// The next attempt to make; empty when nothing waits that this worker may take. A fresh worker
  /// (one that has rendered nothing yet) is given retries that need one before anything else.
  std::optional<FrameJob> next(bool fresh_worker);

  /// Takes a job back that was never started: its attempt does not count.
  bool withdraw(const FrameJob& job);
  /// The worker says it is done.
  bool rendered(const FrameJob& job);
  /// The file is good and stored.
  bool committed(const FrameJob& job);
  /// From handed out or unjudged.
  bool attempt_failed(const FrameJob& job, RetryIn where);
  /// From any state: no attempt would help.
  bool fail_for_good(const FrameJob& job);

  /// Whether a failure of this job would be its frame's last.
  bool is_last_attempt(const FrameJob& job) const;

  /// Nothing is handed out any more.
  void drain() { draining_ = true; }
  bool draining() const { return draining_; }

  bool has_retry_for_fresh_worker() const { return !draining_ && !fresh_.empty(); }
  /// Nothing waits but such retries: an idle worker that is not fresh stands in their way.
  bool wants_fresh_worker() const { return has_retry_for_fresh_worker() && frames_.empty(); }
  std::int64_t waiting() const;
  std::int64_t handed_out() const { return count(State::kHandedOut); }
  std::int64_t unjudged() const { return count(State::kUnjudged); }
  std::int64_t done() const { return done_; }
  std::int64_t failed() const { return failed_; }
  /// Nothing is under way and nothing will be.
  bool finished() const { return open_.empty() && (draining_ || waiting() == 0); }

 private:
  enum class State { kHandedOut, kUnjudged };

  bool is(const FrameJob& job, State state) const;
  std::int64_t count(State state) const;

  int max_attempts_;
  bool draining_ = false;
  std::map<std::int64_t, int> used_before_;  ///< attempts of earlier runs, where there were any
  std::deque<FrameJob> frames_;              ///< the next attempt of each
  std::deque<FrameJob> fresh_;               ///< the same, for fresh workers only
  std::map<FrameJob, State> open_;
  std::int64_t done_ = 0;
  std::int64_t failed_ = 0;
};

}  // namespace seedframe
