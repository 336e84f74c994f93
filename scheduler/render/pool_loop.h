// The event loop behind WorkerPool: what happens when, by poll.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "render/schedule.h"
#include "render/worker_pool.h"
#include "render/worker_process.h"

namespace seedframe {

class WorkerPool::Loop {
 public:
  Loop(PoolOptions options, RenderClient& client);
  ~Loop();

  Result<RunSummary> run(const std::vector<PendingFrame>& frames);
  void post_verdict(const FrameJob& job, Status verdict);
  void drain();

 private:
  using Clock = std::chrono::steady_clock;

  struct Worker {
    enum class State { kStopped, kStarting, kIdle, kBusy };

    int number = 0;
    State state = State::kStopped;
    std::unique_ptr<WorkerProcess> process;
    int start = 0;               ///< which of all starts its process is
    int frames = 0;              ///< rendered or tried by this process
    bool suspect = false;        ///< is replaced when it is idle
    FrameJob job;                ///< when busy
    Clock::time_point since;     ///< when it was started or given its frame
    Clock::time_point deadline;  ///< when starting or busy
  };

  /// Asked of the client ahead of time, so that an idle worker need not wait for it.
  struct PreparedJob {
    FrameJob job;
    std::string message;
  };

  void stop_run(Error error);

  // Work for workers.
  void start_workers(Schedule& schedule);
  void start(Worker& worker);
  void hand_out(Schedule& schedule);
  std::optional<PreparedJob> prepare(Schedule& schedule, bool fresh_worker);
  void give(Worker& worker, const PreparedJob& prepared);
  void retire_workers(Schedule& schedule);

  // What comes from them.
  void wait_for_events();
  void receive_from(Worker& worker, Schedule& schedule);
  /// False when the worker must not go on.
  bool take_line(Worker& worker, const std::string& line, Schedule& schedule);
  bool take_ready(Worker& worker, const ReadyMessage& ready);
  bool take_done(Worker& worker, const DoneMessage& done, Schedule& schedule);
  bool take_failed(Worker& worker, const FailedMessage& failed, Schedule& schedule);
  void check_deadline(Worker& worker, Schedule& schedule);

  /// Ends a worker that did wrong, and counts its frame as failed.
  void give_up(Worker& worker, Schedule& schedule, const std::string& why);
  void fail_attempt(Schedule& schedule, const FrameJob& job, RetryIn where, const std::string& why);
  void stop(Worker& worker, std::chrono::milliseconds patience);
  void stop_all(std::chrono::milliseconds patience);

  // From other threads and signal handlers.
  void take_verdicts(Schedule& schedule);
  void take_verdict(Schedule& schedule, const FrameJob& job, const Status& verdict);
  void take_drain(Schedule& schedule);
  void wake();

  PoolOptions options_;
  RenderClient& client_;
  std::vector<Worker> workers_;
  std::optional<PreparedJob> prepared_;
  std::map<FrameJob, int> rendered_by_;  ///< unjudged jobs and the start of their worker
  std::optional<Error> stopped_by_;
  int starts_ = 0;
  int starts_failed_in_a_row_ = 0;

  int wake_fd_ = -1;
  std::atomic<int> drains_asked_ = 0;
  std::mutex verdicts_mutex_;
  std::vector<std::pair<FrameJob, Status>> verdicts_;
};

}  // namespace seedframe
