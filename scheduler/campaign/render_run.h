// Renders what a campaign still needs: feeds the worker pool, finishes frames beside it, keeps the
// store.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/finish_queue.h"
#include "campaign/frame_cache.h"
#include "campaign/provenance.h"
#include "campaign/run_options.h"
#include "campaign/store_writer.h"
#include "frames/frame_finisher.h"
#include "image/color_management.h"
#include "render/local_executor.h"

namespace seedframe {

/// The colour config of a campaign, its view checked against it, and that pictures can be written
/// as it asks for.
Result<ColorManagement> load_color_management(const CampaignSettings& settings,
                                              const BlenderInfo& blender);

class RenderRun : public CampaignRun, public RenderClient {
 public:
  RenderRun(Campaign& campaign, PreparedCampaign& prepared, Provenance& provenance,
            const RunSetup& setup, RunObserver& observer);
  ~RenderRun() override;

  Result<RunSummary> run(const std::vector<PendingFrame>& frames) override;
  /// See WorkerPool::drain.
  void drain() override { pool_->drain(); }

 private:
  Result<std::optional<RenderRequest>> request(const FrameJob& job) override;
  void started(const FrameJob& job, int worker) override;
  void rendered(const FrameJob& job, const RenderTimings& timings, int worker) override;
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override;
  Status check_system() override;
  void worker_ready(int worker, const ReadyMessage& ready) override;

  /// Commits the frame from another campaign, if it was rendered with the same; false if not.
  bool take_from_cache(const FrameJob& job, const std::string& frame_id,
                       const std::filesystem::path& attempt);
  void add_to_cache(const FrameJob& job);
  /// Writes those that no frame before had. Returns the files' paths by SHA-256.
  Result<std::map<std::string, std::filesystem::path>> write_mesh_buffers(
      const MeshBuffers& meshes);
  /// Takes as long as finishing several frames, so it is done while Blender starts.
  void load_view_tables();
  void finish(const FrameJob& job, const RenderTimings& timings, const FinishTask& task);
  void written(const StoreEvent& event, const Status& status);
  /// Where to look, and what to do to see it again.
  void keep_crash_log(const FrameJob& job, const AttemptFailure& failure) const;
  /// The store failed: nothing more can be trusted, so the run ends.
  void keep_error(const Status& status);

  Campaign& campaign_;
  PreparedCampaign& prepared_;
  std::shared_ptr<const ColorManagement> color_;
  Provenance& provenance_;
  RunObserver& observer_;
  std::uint64_t room_needed_;          ///< bytes that frames under way may still take
  std::unique_ptr<FrameCache> cache_;  ///< null: there is none
  bool take_from_cache_;
  std::atomic<bool> same_workers_ = true;  ///< all with the same provenance
  std::string made_with_;                  ///< by the first worker that was ready
  std::string cache_key_;                  ///< of that
  std::int64_t from_cache_ = 0;
  FrameFinisher finisher_;
  std::map<FrameJob, FinishTask> tasks_;  ///< requested and not yet rendered
  std::map<int, std::string> provenance_of_worker_;
  bool departure_noted_ = false;
  std::mutex mutex_;  ///< guards error_
  Status error_;
  std::unique_ptr<StoreWriter> writer_;  ///< the only one to use the store and the observer
  std::unique_ptr<FinishQueue> queue_;
  LocalExecutor executor_;
  std::unique_ptr<WorkerPool> pool_;
};

}  // namespace seedframe
