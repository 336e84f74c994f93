// Makes the labels of a campaign without Blender: every frame by its twin (labels: geometry).
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/finish_queue.h"
#include "campaign/frame_finisher.h"
#include "campaign/store_writer.h"

namespace seedframe {

class LabelRun : public CampaignRun {
 public:
  /// Of the options, `workers` says on how many threads frames are traced.
  LabelRun(Campaign& campaign, PreparedCampaign& prepared, const RunOptions& options,
           RunObserver& observer);
  ~LabelRun() override;

  Result<RunSummary> run(const std::vector<PendingFrame>& frames) override;
  void drain() override { drained_ = true; }

 private:
  /// Expands a frame and hands it to the threads; waits while they have enough to do.
  void begin(const FrameJob& job);
  void finish(const FrameJob& job, const FinishTask& task);
  void written(const StoreEvent& event, const Status& status);
  Status prepare_folders() const;

  Campaign& campaign_;
  PreparedCampaign& prepared_;
  RunObserver& observer_;
  int threads_;
  FrameFinisher finisher_;
  std::atomic<bool> drained_ = false;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  int under_way_ = 0;
  RunSummary summary_;
  Status error_;  ///< of the store: nothing more can be trusted, so the run ends
  std::unique_ptr<StoreWriter> writer_;  ///< the only one to use the store and the observer
  std::unique_ptr<FinishQueue> queue_;
};

}  // namespace seedframe
