// What every run has, wherever its frames come from: the folders it works in, the threads that
// finish frames, the writer that commits them, and the first error, which ends it.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "base/clock.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/finish_queue.h"
#include "campaign/store_writer.h"

namespace seedframe {

/// Called from other threads than the run's own.
class FinishClient {
 public:
  virtual ~FinishClient() = default;

  /// What was written of a frame that was finished; an error when the store could not.
  virtual void frame_written(const FrameJob& job, const Status& status) = 0;
  virtual void failure_written(const FrameJob& job) = 0;
  /// There was an error, perhaps not the first: nothing more can be trusted, so no more frames are
  /// to be begun.
  virtual void ends() = 0;
};

/// Tells the observer of the run what becomes of its frames. From open() to close() it alone uses
/// the store.
class FinishStage {
 public:
  /// `threads` finish frames. All must outlive it.
  FinishStage(Campaign& campaign, RunObserver& observer, FinishClient& client, int threads)
      : campaign_(campaign), observer_(observer), client_(client), threads_(threads) {}
  /// Waits as close() does.
  ~FinishStage();
  FinishStage(const FinishStage&) = delete;
  FinishStage& operator=(const FinishStage&) = delete;

  /// Makes the folders that frames are worked on in.
  Status open();

  /// In one of the threads, after what was pushed before.
  void push(std::function<void()> work) { queue_->push(std::move(work)); }

  /// `started`: Unix time, seconds.
  void begin(const FrameJob& job, int worker, const std::string& provenance,
             double started = unix_time());
  /// Its files lie in the attempt's folder.
  void commit(FrameFinished frame) { writer_->push(std::move(frame)); }
  /// The attempt's folder goes.
  void fail(const FrameJob& job, AttemptFailure failure);
  /// The disk, the memory or the store is to blame.
  void end(const Error& error);
  /// Tells the observer, which is told one thing at a time.
  void note(const std::string& text);

  /// Waits for what is being finished and written, and removes what frames were worked on in. The
  /// first error.
  Status close();

 private:
  void written(const StoreEvent& event, const Status& status);

  Campaign& campaign_;
  RunObserver& observer_;
  FinishClient& client_;
  int threads_;
  std::mutex observer_mutex_;
  std::mutex mutex_;  ///< guards outcome_
  Status outcome_;    ///< the first error, if there was any
  std::unique_ptr<StoreWriter> writer_;
  std::unique_ptr<FinishQueue> queue_;
};

}  // namespace seedframe
