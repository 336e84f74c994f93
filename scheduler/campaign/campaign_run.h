// Makes what a campaign still needs: by Blender (render_run.h), or by the twin alone (label_run.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "render/frame_job.h"
#include "render/worker_pool.h"

namespace seedframe {

/// What a run tells while it runs; called from its own threads, one at a time.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void frame_done(std::int64_t frame) = 0;
  virtual void attempt_failed(const FrameJob& job, const AttemptFailure& failure) = 0;
  /// Something that the user should know, in a sentence.
  virtual void noted(const std::string& text) = 0;
  /// Nothing can be written, or there is no memory: the run waits, at most so long, for it to pass.
  virtual void paused(const Error& why, double limit_s) = 0;
  /// After a pause, with so many frames.
  virtual void goes_on(std::int64_t frames) = 0;
};

class CampaignRun {
 public:
  virtual ~CampaignRun() = default;

  /// Returns when each of `frames` is done or failed, or the run was drained.
  virtual Result<RunSummary> run(const std::vector<PendingFrame>& frames) = 0;

  /// No new frames are begun. Async-signal-safe.
  virtual void drain() = 0;
};

}  // namespace seedframe
