// The event loop behind WorkerPool: what happens when.
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

namespace seedframe {

class WorkerPool::Loop {
 public:
  Loop(const PoolOptions& options, Executor& executor, RenderClient& client);

  Result<RunSummary> run(const std::vector<PendingFrame>& frames);
  void post_verdict(const FrameJob& job, Status verdict);
  void add(const PendingFrame& frame);
  void drain();

 private:
  using Clock = Executor::Clock;

  static constexpr int kNoStart = 0;                          ///< of a worker: the first one is 1
  static constexpr std::chrono::milliseconds kPatience{500};  ///< for a worker to end by itself

  /// The place of a worker, which is filled again when its worker is gone.
  struct Slot {
    enum class State { kStopped, kStarting, kIdle, kBusy, kEnding };

    int number = 0;
    State state = State::kStopped;
    std::shared_ptr<Worker> worker;
    int start = 0;                     ///< which of all starts its worker is
    int frames = 0;                    ///< rendered or tried by this worker
    bool suspect = false;              ///< is replaced when it is idle
    std::int64_t memory_bytes = 0;     ///< as it said last
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
  bool is_over(const Schedule& schedule) const;

  // Work for workers.
  void start_workers(Schedule& schedule);
  void start(Slot& slot);
  /// See PoolOptions::begin_together.
  bool waits_for_others();
  void hand_out(Schedule& schedule);
  std::optional<PreparedJob> prepare(Schedule& schedule, bool fresh_worker);
  void give(Slot& slot, const PreparedJob& prepared, const Schedule& schedule);
  void retire_workers(Schedule& schedule);

  // What comes from them.
  void wait_for_events();
  void receive_from(Slot& slot, Schedule& schedule);
  /// False when the worker must not go on.
  bool take_line(Slot& slot, const std::string& line, Schedule& schedule);
  bool take_ready(Slot& slot, const ReadyMessage& ready);
  bool take_answer(Slot& slot, const FrameJob& job);
  void take_done(Slot& slot, const DoneMessage& done, Schedule& schedule);
  void check_deadline(Slot& slot);

  // The end of workers.
  /// Begins the end of one that did wrong: `wrong` says what, or is empty when it closed the
  /// channel. Its frame is charged when it has ended.
  void give_up(Slot& slot, std::string wrong);
  void stop(Slot& slot, std::chrono::milliseconds patience);
  void take_end(Slot& slot, Schedule& schedule);
  void charge_end(const Slot& slot, const WorkerEnd& end, Schedule& schedule);
  void fail_attempt(Schedule& schedule, const FrameJob& job, Failure failure, std::string message,
                    std::string log);
  void stop_all(Schedule& schedule);

  // From other threads and signal handlers.
  void take_added(Schedule& schedule);
  void take_verdicts(Schedule& schedule);
  void take_verdict(Schedule& schedule, const FrameJob& job, const Status& verdict);
  void take_drain(Schedule& schedule);

  PoolOptions options_;
  Executor& executor_;
  RenderClient& client_;
  std::vector<Slot> slots_;
  FrameTimeout timeout_;
  std::optional<PreparedJob> prepared_;
  std::map<FrameJob, int> rendered_by_;  ///< unjudged jobs and the start of their worker
  std::optional<Error> stopped_by_;
  bool has_begun_ = false;  ///< frames are handed out
  int starts_ = 0;
  int starts_failed_in_a_row_ = 0;

  std::atomic<int> drains_asked_ = 0;
  std::mutex verdicts_mutex_;  ///< guards what follows
  std::vector<PendingFrame> added_;
  std::vector<std::pair<FrameJob, Status>> verdicts_;
};

}  // namespace seedframe
