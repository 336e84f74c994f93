// Makes what a campaign still needs: by Blender (render_run.h), or by the twin alone (label_run.h).
#pragma once

#include <chrono>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "render/blender_info.h"
#include "render/frame_job.h"
#include "render/worker_pool.h"

namespace seedframe {

struct RunOptions {
  BlenderInfo blender;            ///< of no meaning when nothing is rendered
  std::filesystem::path scripts;  ///< blender_scripts/
  int workers = 1;                ///< Blender processes; without Blender threads
  int threads = 1;                ///< of each worker
  int max_attempts = 3;
  std::chrono::milliseconds frame_timeout = std::chrono::seconds(600);
};

/// What a run tells while it runs; called from its own threads, one at a time.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void frame_done(std::int64_t frame) = 0;
  virtual void attempt_failed(const FrameJob& job, const std::string& message, bool final) = 0;
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
