// Makes what a campaign still needs: by Blender (render_run.h), or by the twin alone (label_run.h).
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
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
  WorkerConditions conditions;
  std::filesystem::path preload;  ///< see environment_of
  /// Set in the workers' environment on top of all else.
  std::map<std::string, std::string> environment;
  AttemptLimits attempts;
  std::chrono::milliseconds frame_timeout = std::chrono::seconds(600);
  std::chrono::milliseconds heartbeat_timeout = std::chrono::seconds(120);
  int frames_per_worker = 0;             ///< 0: a worker is never worn out
  std::int64_t worker_memory_bytes = 0;  ///< a larger one is replaced; 0: none is
  bool sandbox = false;                  ///< see sandbox.h
  std::uint64_t frame_bytes = 0;         ///< that a frame takes on the disk, about
  std::filesystem::path
      cache;  ///< folder of the FrameCache; empty: frames are neither taken nor added
  bool take_from_cache = true;  ///< false: only add
};

/// What a run tells while it runs; called from its own threads, one at a time.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void frame_done(std::int64_t frame) = 0;
  virtual void attempt_failed(const FrameJob& job, const AttemptFailure& failure) = 0;
  /// Something that the user should know, in a sentence.
  virtual void noted(const std::string& text) = 0;
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
