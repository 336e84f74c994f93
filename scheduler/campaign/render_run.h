// Renders what a campaign still needs: takes what the cache has, feeds the worker pool with the
// rest, finishes frames beside it.
#pragma once

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/cached_frames.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/disk_space.h"
#include "campaign/finish_stage.h"
#include "campaign/provenance.h"
#include "campaign/run_options.h"
#include "frames/frame_finisher.h"
#include "image/color_management.h"
#include "render/local_executor.h"

namespace seedframe {

class RenderRun : public CampaignRun, private RenderClient, private FinishClient {
 public:
  RenderRun(Campaign& campaign, const PreparedCampaign& prepared, Provenance& provenance,
            const RunSetup& setup, RunObserver& observer);
  ~RenderRun() override;

  Result<RunSummary> run(const std::vector<PendingFrame>& frames) override;
  /// See WorkerPool::drain.
  void drain() override;

 private:
  // What the pool asks and tells.
  Result<std::optional<RenderRequest>> request(const FrameJob& job) override;
  void started(const FrameJob& job, int worker) override;
  void rendered(const FrameJob& job, const RenderTimings& timings, int worker) override;
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override;
  Status check_system() override;
  void worker_ready(int worker, const ReadyMessage& ready) override;

  // What becomes of frames.
  void frame_written(const FrameJob& job, const Status& status) override;
  void failure_written(const FrameJob&) override {}
  void ends() override;

  using FrameIds = std::map<std::int64_t, std::string>;  ///< by frame
  /// An attempt that has begun, as the cache needs to know it.
  struct Attempt {
    std::string frame_id;
    std::string made_with;  ///< its provenance
  };

  /// Takes what it can of `found` before any worker is needed, and renders the rest.
  Result<RunSummary> run_once(const std::vector<PendingFrame>& frames, const FrameIds& found);

  /// Frames that the cache has of what a worker would make, as far as that is known before one has
  /// started.
  Result<FrameIds> find_in_cache(const std::vector<PendingFrame>& frames);
  /// Commits these; returns the frames that are left.
  std::vector<PendingFrame> take_before_workers(const std::vector<PendingFrame>& frames,
                                                const FrameIds& found);
  /// Commits a frame as it was rendered for another campaign; false if it is not in the cache.
  Result<bool> take(const FrameJob& job, const std::string& frame_id);
  /// A worker is not what was expected: what was taken before it came is to be rendered.
  Result<std::vector<PendingFrame>> give_back();

  Status look_for_room() const;
  void begin(const FrameJob& job, int worker, Attempt attempt);
  /// What begin was told.
  Attempt ended(const FrameJob& job);
  /// Takes as long as finishing several frames, so it is done while Blender starts.
  void load_view_tables();
  void finish(const FrameJob& job, const RenderTimings& timings, const FinishTask& task);
  void tell_departure(const std::string& made_with);
  /// Where to look, and what to do to see it again.
  void keep_crash_log(const FrameJob& job, const AttemptFailure& failure) const;

  Campaign& campaign_;
  const PreparedCampaign& prepared_;
  Provenance& provenance_;
  std::shared_ptr<const ColorManagement> color_;
  std::filesystem::path meshes_;  ///< folder of mesh buffers
  DiskRoom room_needed_;          ///< that frames under way may still take
  CachedFrames cached_;
  FrameFinisher finisher_;
  std::map<FrameJob, FinishTask> tasks_;  ///< requested and not yet rendered
  std::map<int, std::string> provenance_of_worker_;
  bool departure_told_ = false;
  std::vector<std::int64_t> taken_;  ///< before any worker started
  std::atomic<std::int64_t> from_cache_ = 0;
  std::atomic<bool> drained_ = false;
  std::mutex mutex_;  ///< guards attempts_
  std::map<FrameJob, Attempt> attempts_;
  LocalExecutor executor_;
  /// The second is for what was given back. Both are there from the beginning, since a signal may
  /// drain them at any time.
  std::array<std::unique_ptr<WorkerPool>, 2> pools_;
  std::size_t pool_ = 0;  ///< the one at work
  FinishStage stage_;     ///< its threads use all of the above
};

}  // namespace seedframe
