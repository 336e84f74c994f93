// The event loop behind WorkerPool: what happens when, by poll.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "render/frame_timeout.h"
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

  static constexpr int kNoStart = 0;                          ///< of a worker: the first one is 1
  static constexpr std::chrono::milliseconds kPatience{500};  ///< for a worker to end by itself

  struct Worker {
    enum class State { kStopped, kStarting, kIdle, kBusy, kEnding };

    int number = 0;
    State state = State::kStopped;
    std::unique_ptr<WorkerProcess> process;
    int start = 0;                     ///< which of all starts its process is
    int frames = 0;                    ///< rendered or tried by this process
    bool suspect = false;              ///< is replaced when it is idle
    std::int64_t memory_bytes = 0;     ///< as it said last
    std::int64_t memory_kills = 0;     ///< of the kernel, when it was started
    FrameJob job;                      ///< when busy
    Clock::time_point since;           ///< when it was started or given its frame
    Clock::time_point deadline;        ///< when starting or busy
    Clock::time_point heartbeat;       ///< when busy: by then something must have come
    std::optional<std::string> wrong;  ///< when ending: what it did; empty: it closed the channel
    std::optional<FrameJob> charged;   ///< when ending: the frame that is to blame
    bool was_starting = false;         ///< when ending
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
  void give(Worker& worker, const PreparedJob& prepared, const Schedule& schedule);
  void retire_workers(Schedule& schedule);

  // What comes from them.
  void wait_for_events();
  void receive_from(Worker& worker, Schedule& schedule);
  /// False when the worker must not go on.
  bool take_line(Worker& worker, const std::string& line, Schedule& schedule);
  bool take_ready(Worker& worker, const ReadyMessage& ready);
  bool take_answer(Worker& worker, const FrameJob& job);
  void take_done(Worker& worker, const DoneMessage& done, Schedule& schedule);
  void check_deadline(Worker& worker);

  // The end of workers.
  /// Begins the end of one that did wrong: `wrong` says what, or is empty when it closed the
  /// channel. Its frame is charged when it has ended.
  void give_up(Worker& worker, std::string wrong);
  void begin_end(Worker& worker, std::chrono::milliseconds patience);
  void take_end(Worker& worker, Schedule& schedule);
  void charge_end(const Worker& worker, const WorkerEnd& end, Schedule& schedule);
  void fail_attempt(Schedule& schedule, const FrameJob& job, Failure failure, std::string message,
                    std::string log);
  void stop_all(Schedule& schedule);

  // From other threads and signal handlers.
  void take_verdicts(Schedule& schedule);
  void take_verdict(Schedule& schedule, const FrameJob& job, const Status& verdict);
  void take_drain(Schedule& schedule);
  void wake();
  void take_wake();

  PoolOptions options_;
  RenderClient& client_;
  std::vector<Worker> workers_;
  FrameTimeout timeout_;
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
