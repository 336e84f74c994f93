// Which frame next, and what became of each: the plan of a run, with no process, disk or clock.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "render/frame_job.h"

namespace seedframe {

struct AttemptLimits {
  int errors = 3;   ///< of a frame in this run: who resumes a campaign has mended something
  int crashes = 3;  ///< of a frame over the campaign's life: then it is quarantined
};

/// Every frame is in one of these states, and every attempt is counted once:
///
///     waiting --next--> handed out --rendered--> unjudged --committed--> done
///        ^                  |                       |
///        |---- failed ------|-----------------------|---> failed or quarantined
///
/// A frame that cost a worker is suspected: its next attempt is made by a worker that has rendered
/// nothing yet, and its last one while no other frame is rendered at all, so that nobody else can
/// be to blame. Those last attempts wait until there is nothing else to do. After a bad file
/// anybody but its worker may try, a last time a worker that has rendered nothing yet.
///
/// Calls about a job that is not in the state that they ask for change nothing and return false (or
/// nothing), so a late or repeated answer can do no harm.
class Schedule {
 public:
  Schedule(const std::vector<PendingFrame>& frames, const AttemptLimits& limits);

  /// One more, after those that wait.
  void add(const PendingFrame& frame);

  /// The next attempt to make; empty when nothing waits that this worker may take. A fresh worker
  /// (one that has rendered nothing yet) is given retries that need one before anything else.
  std::optional<FrameJob> next(bool fresh_worker);

  /// Takes a job back that nobody is to blame for: its attempt does not count.
  bool withdraw(const FrameJob& job);
  /// The worker says it is done.
  bool rendered(const FrameJob& job);
  /// The file is good and stored.
  bool committed(const FrameJob& job);
  /// From handed out or unjudged; what becomes of the frame.
  std::optional<Consequence> attempt_failed(const FrameJob& job, Failure failure);
  /// From any state: no attempt would help.
  bool fail_for_good(const FrameJob& job);

  /// Nothing is handed out any more.
  void drain() { draining_ = true; }
  bool draining() const { return draining_; }

  bool has_retry_for_fresh_worker() const { return !draining_ && !fresh_.empty(); }
  /// Nothing can go on but such retries: an idle worker that is not fresh stands in their way.
  bool wants_fresh_worker() const;
  /// As many idle workers would be given a frame now.
  std::int64_t workers_wanted() const;

  /// Attempts of this frame that have cost a worker.
  int crashes(std::int64_t frame) const;

  std::int64_t waiting() const;
  std::int64_t handed_out() const { return count(State::kHandedOut); }
  std::int64_t unjudged() const { return count(State::kUnjudged); }
  std::int64_t done() const { return done_; }
  std::int64_t failed() const { return failed_; }
  std::int64_t quarantined() const { return quarantined_; }
  /// Nothing is under way and nothing will be.
  bool finished() const { return open_.empty() && (draining_ || waiting() == 0); }

 private:
  enum class State { kHandedOut, kUnjudged };
  struct Charges {
    int errors = 0;
    int crashes = 0;
  };

  std::deque<FrameJob>& queue_after_crash(std::int64_t frame);
  bool can_run_alone() const;
  /// The job is no longer at a worker.
  void left_worker(const FrameJob& job);
  bool is(const FrameJob& job, State state) const;
  std::int64_t count(State state) const;

  AttemptLimits limits_;
  bool draining_ = false;
  std::map<std::int64_t, Charges> charges_;  ///< of the few frames that have any
  std::deque<FrameJob> frames_;              ///< the next attempt of each
  std::deque<FrameJob> fresh_;               ///< the same, for fresh workers only
  std::deque<FrameJob> alone_;               ///< the same, for a fresh worker while no other works
  std::optional<FrameJob> runs_alone_;
  std::map<FrameJob, State> open_;
  std::int64_t done_ = 0;
  std::int64_t failed_ = 0;
  std::int64_t quarantined_ = 0;
};

}  // namespace seedframe
