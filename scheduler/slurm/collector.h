// From the records of tasks to the campaign: each frame is checked, moved to where attempts lie,
// and committed as any other.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "campaign/campaign.h"
#include "campaign/finish_stage.h"
#include "campaign/provenance.h"
#include "slurm/frame_ledger.h"
#include "slurm/task_frame.h"
#include "slurm/task_plan.h"

namespace seedframe {

class Collector {
 public:
  /// `ocio_hash`: of the colours that the campaign's pictures have; empty: it has no pictures. All
  /// must outlive it.
  Collector(const CampaignFiles& files, Provenance& provenance, std::string ocio_hash,
            FrameLedger& ledger, FinishStage& stage)
      : files_(files),
        provenance_(provenance),
        ocio_hash_(std::move(ocio_hash)),
        ledger_(ledger),
        stage_(stage) {}

  /// The nodes that frames of this campaign have come from.
  Status load_nodes();

  /// Takes what lies in a batch's results and is not taken yet; how many records there were.
  Result<std::int64_t> collect(const std::filesystem::path& results, TaskTimes& times);

  /// For frames that no task could say anything of.
  void fail(std::int64_t frame, const FrameLedger::Lost& lost, const std::string& message);

  // What the stage tells.
  void frame_written(const FrameJob& job);
  void failure_written(const FrameJob& job);

 private:
  struct Found {
    TaskFrame record;
    std::filesystem::path results;
    int first_attempt = 1;
    std::string frame_id;
  };

  Result<int> number_of(const std::string& node);
  /// Why the record is not one of this campaign's frames; empty if it is.
  std::string refusal(const Found& found) const;
  /// In one of the stage's threads.
  void settle(const Found& found);
  Status move_frame(const Found& found, const FrameJob& job, Manifest& manifest) const;
  void move_evidence(const Found& found) const;
  void end_attempt(const FrameJob& job, AttemptFailure failure);

  const CampaignFiles& files_;
  Provenance& provenance_;
  std::string ocio_hash_;
  FrameLedger& ledger_;
  FinishStage& stage_;
  std::vector<std::string> nodes_;
  std::set<std::filesystem::path> seen_;  ///< records
  std::mutex mutex_;                      ///< guards what follows
  std::map<FrameJob, Consequence> failing_;
};

}  // namespace seedframe
