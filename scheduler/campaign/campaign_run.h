// Renders what a campaign still needs: feeds the worker pool, finishes frames beside it, keeps the
// store.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/finish_queue.h"
#include "campaign/frame_finisher.h"
#include "campaign/provenance.h"
#include "campaign/store_writer.h"
#include "image/color_management.h"
#include "render/blender_info.h"
#include "render/worker_pool.h"

namespace seedframe {

struct RunOptions {
  BlenderInfo blender;
  std::filesystem::path scripts;  ///< blender_scripts/
  int workers = 1;
  int threads = 1;  ///< of each worker
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

/// The colour config of a campaign, its view checked against it.
Result<ColorManagement> load_color_management(const CampaignConfig& config,
                                              const BlenderInfo& blender);

class CampaignRun : public RenderClient {
 public:
  CampaignRun(Campaign& campaign, PreparedCampaign& prepared, const ColorManagement& color,
              Provenance& provenance, const RunOptions& options, RunObserver& observer);
  ~CampaignRun() override;

  /// Returns when each of `frames` is done or failed, or the run was drained.
  Result<RunSummary> run(const std::vector<PendingFrame>& frames);

  /// Async-signal-safe; see WorkerPool::drain.
  void drain() { pool_->drain(); }

 private:
  Result<RenderRequest> request(const FrameJob& job) override;
  void started(const FrameJob& job, int worker) override;
  void rendered(const FrameJob& job, const RenderTimings& timings, int worker) override;
  void attempt_failed(const FrameJob& job, const std::string& message, bool final) override;
  void worker_ready(int worker, const ReadyMessage& ready) override;

  Result<std::map<std::string, std::filesystem::path>> write_mesh_buffers(
      const ExpandedFrame& frame);
  /// Takes as long as finishing several frames, so it is done while Blender starts.
  void load_view_tables();
  void finish(const FrameJob& job, const RenderTimings& timings, const FinishTask& task);
  void written(const StoreEvent& event, const Status& status);
  /// The store failed: nothing more can be trusted, so the run ends.
  void keep_error(const Status& status);

  Campaign& campaign_;
  PreparedCampaign& prepared_;
  const ColorManagement& color_;
  Provenance& provenance_;
  RunObserver& observer_;
  std::map<FrameJob, FinishTask> tasks_;  ///< requested and not yet rendered
  std::mutex mutex_;                      ///< guards error_
  Status error_;
  std::unique_ptr<StoreWriter> writer_;  ///< the only one to use the store and the observer
  std::unique_ptr<FinishQueue> queue_;
  std::unique_ptr<WorkerPool> pool_;
};

}  // namespace seedframe
