// Keeps workers busy with frames, and survives whatever they do.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "render/frame_job.h"
#include "render/message.h"
#include "render/schedule.h"
#include "render/worker.h"

namespace seedframe {

struct PoolOptions {
  int workers = 1;
  AttemptLimits attempts;
  std::chrono::milliseconds frame_timeout = std::chrono::seconds(600);  ///< see FrameTimeout
  /// Frames take about as long as each other, so that FrameTimeout may learn from them; else
  /// frame_timeout alone counts.
  bool equal_frames = true;
  std::chrono::milliseconds start_timeout = std::chrono::seconds(120);
  /// A worker that says nothing for so long hangs, whatever it may still take over its frame.
  std::chrono::milliseconds heartbeat_timeout = std::chrono::seconds(120);
  /// A worker is replaced after so many frames; 0: never.
  int frames_per_worker = 2000;
  /// A worker that has grown above this (resident, bytes) is replaced after its frame; 0: never.
  std::int64_t worker_memory_bytes = 0;
  /// No frame is handed out before all workers that it begins with are ready, so that each gets one
  /// of the first frames, however long it took to start.
  bool begin_together = false;
  /// run() does not return when nothing is left: frames are added until it is drained.
  bool stays = false;
  /// No new frame starts while so many wait for their verdict, which bounds the disk they take.
  int max_unjudged = 64;
};

/// What the pool asks and tells. All calls come from the thread that is in WorkerPool::run and must
/// return at once. For one job the order is: request, started, then rendered or attempt_failed;
/// after rendered the job is open until post_verdict.
class RenderClient {
 public:
  virtual ~RenderClient() = default;

  /// May be called some time before started, and again for the same job if that never came.
  /// Nothing: no worker is needed, started is not called, and the verdict comes as after rendered.
  /// A kEnvironment or kExhausted error ends the run; any other fails the frame for good.
  virtual Result<std::optional<RenderRequest>> request(const FrameJob& job) = 0;
  virtual void started(const FrameJob& job, int worker) = 0;
  /// The worker says that the file is written. Hand it to post-processing, which must answer with
  /// post_verdict.
  virtual void rendered(const FrameJob& job, const RenderTimings& timings, int worker) = 0;
  /// Also called for bad verdicts.
  virtual void attempt_failed(const FrameJob& job, const AttemptFailure& failure) = 0;
  /// Asked before a frame is charged with a failure. An error says that the system is to blame (a
  /// full disk): it ends the run, and the attempt does not count.
  virtual Status check_system() = 0;
  virtual void worker_ready(int worker, const ReadyMessage& ready) = 0;
};

struct RunSummary {
  std::int64_t committed = 0;    ///< frames with a good verdict
  std::int64_t failed = 0;       ///< frames that failed for good
  std::int64_t quarantined = 0;  ///< frames that cost too many workers
  std::int64_t left = 0;         ///< frames not done because the run was drained
  int worker_starts = 0;
  std::int64_t from_cache = 0;  ///< of those committed, found on this machine
};

/// Frames go to workers one at a time; a worker that dies, hangs, answers nonsense or writes a bad
/// file is ended and replaced, and its frame is tried again in a fresh one (schedule.h).
class WorkerPool {
 public:
  /// Both must outlive it.
  WorkerPool(const PoolOptions& options, Executor& executor, RenderClient& client);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Returns when every frame is committed or failed for good, or the run is drained; no worker is
  /// left then. Failed frames are no error of the run. kEnvironment errors: workers that never get
  /// ready (with the end of their log), and those of the executor and the client; kExhausted: a
  /// worker was killed for lack of memory, and those of the client. To be called once. It ignores
  /// nothing and installs no signal handlers.
  Result<RunSummary> run(const std::vector<PendingFrame>& frames);

  /// The outcome of post-processing; from any thread. An error counts as a failed attempt and the
  /// worker that rendered it is replaced, except kEnvironment and kExhausted (a full disk), which
  /// end the run instead.
  void post_verdict(const FrameJob& job, Status verdict);

  /// One more frame for a run that stays; from any thread, also before run().
  void add(const PendingFrame& frame);

  /// No new frames: run returns when those under way have been rendered and judged. The second call
  /// kills the workers and waits for verdicts only. Async-signal-safe, from any thread.
  void drain();

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace seedframe
