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
#include "campaign/provenance.h"
#include "campaign/run_options.h"
#include "campaign/store_writer.h"
#include "frames/frame_finisher.h"

namespace seedframe {

class LabelRun : public CampaignRun {
 public:
  LabelRun(Campaign& campaign, PreparedCampaign& prepared, Provenance& provenance,
           const RunSetup& setup, RunObserver& observer);
  ~LabelRun() override;

  Result<RunSummary> run(const std::vector<PendingFrame>& frames) override;
  void drain() override { drained_ = true; }

 private:
  /// Expands a frame and hands it to the threads; waits while they have enough to do.
  void begin(const FrameJob& job);
  void finish(const FrameJob& job, const FinishTask& task);
  /// A frame that is not to be had fails; without disk or memory the run ends, and nothing fails.
  void give_up(const FrameJob& job, const Error& error);
  void written(const StoreEvent& event, const Status& status);
  Status prepare_folders() const;

  Campaign& campaign_;
  PreparedCampaign& prepared_;
  Provenance& provenance_;
  std::string made_with_;  ///< provenance of every attempt
  RunObserver& observer_;
  int frames_at_once_;
  FrameFinisher finisher_;
  std::atomic<bool> drained_ = false;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  int under_way_ = 0;
  RunSummary summary_;
  Status error_;                         ///< of the store, the disk or the memory: the run ends
  std::unique_ptr<StoreWriter> writer_;  ///< the only one to use the store and the observer
  std::unique_ptr<FinishQueue> queue_;
};

}  // namespace seedframe
