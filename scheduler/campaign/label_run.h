// Makes the labels of a campaign without Blender: every frame by its twin (labels: geometry).
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/finish_stage.h"
#include "campaign/provenance.h"
#include "campaign/run_options.h"
#include "frames/frame_finisher.h"

namespace seedframe {

class LabelRun : public CampaignRun, private FinishClient {
 public:
  /// Of the options, the pool's workers say how many frames are traced at once, and their threads
  /// on how many threads each.
  LabelRun(Campaign& campaign, const PreparedCampaign& prepared, Provenance& provenance,
           const RunSetup& setup, RunObserver& observer);

  Result<RunSummary> run(const std::vector<PendingFrame>& frames) override;
  void drain() override { drained_ = true; }

 private:
  void frame_written(const FrameJob& job, const Status& status) override;
  void failure_written(const FrameJob& job) override;
  void ends() override { drained_ = true; }

  /// Expands a frame and hands it to the threads; waits while they have enough to do.
  void begin(const FrameJob& job, const std::string& made_with);
  void finish(const FrameJob& job, const FinishTask& task);
  /// A frame that cannot be made fails; without disk or memory the run ends, and nothing fails.
  void give_up(const FrameJob& job, const Error& error);
  /// One frame fewer is under way, and counts as this.
  void settle(std::int64_t RunSummary::*count);

  Campaign& campaign_;
  const PreparedCampaign& prepared_;
  Provenance& provenance_;
  int frames_at_once_;
  FrameFinisher finisher_;
  std::atomic<bool> drained_ = false;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  int under_way_ = 0;
  RunSummary summary_;
  FinishStage stage_;  ///< its threads use all of the above
};

}  // namespace seedframe
