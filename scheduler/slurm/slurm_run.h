// A run on a Slurm cluster: gives batches of frames to array tasks, watches them, and collects what
// they have made. Only it opens the store; the tasks run task_run.h.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/finish_stage.h"
#include "campaign/provenance.h"
#include "campaign/run_options.h"
#include "slurm/collector.h"
#include "slurm/frame_ledger.h"
#include "slurm/slurm_commands.h"
#include "slurm/slurm_options.h"
#include "slurm/task_book.h"
#include "slurm/task_plan.h"

namespace seedframe {

class SlurmRun : public CampaignRun, private FinishClient {
 public:
  /// `asked`: the options before any choice, which nodes make for themselves.
  SlurmRun(Campaign& campaign, const PreparedCampaign& prepared, Provenance& provenance,
           const RunSetup& setup, RunObserver& observer, const SlurmOptions& options,
           const RunOptions& asked);

  /// kInput: Slurm refuses such jobs. kEnvironment: there is no Slurm, its controller has given no
  /// answer for long, or tasks end before they have begun wherever they are started.
  Result<RunSummary> run(const std::vector<PendingFrame>& frames) override;

  /// Once: what waits is cancelled, what runs is told to stop, and collected. Twice: returns with
  /// tasks at work, which the next run finds.
  void drain() override { ++drains_; }

 private:
  void frame_written(const FrameJob& job, const Status&) override { collector_.frame_written(job); }
  void failure_written(const FrameJob& job) override { collector_.failure_written(job); }
  void ends() override { ended_ = true; }

  Status begin(const std::vector<PendingFrame>& frames);
  Status loop();
  /// One look at everything; whether the run is over.
  Result<bool> look();
  void sleep() const;

  // What came of tasks.
  Status collect_all();
  Status judge(const std::vector<QueuedTask>& queue);
  Status judge_batch(HeadSubmission& submission, int index, const QueuedTask* task);
  Status close(HeadSubmission& submission, int index);
  Status close_unstarted(HeadSubmission& submission);
  void blame(const HeadSubmission& submission, int index, const TaskEnd& end);
  Status leave_out_bad_nodes();
  Status check_hope() const;
  std::string last_words(const HeadSubmission& submission, int index) const;

  // What is given out.
  Status plan();
  std::vector<std::vector<std::int64_t>> batches_of(const std::vector<std::int64_t>& frames,
                                                    int losses, std::int64_t most_batches) const;
  Status submit_group(const std::vector<std::int64_t>& frames, int losses,
                      const std::string& avoided, std::int64_t& room);
  Status send_due();
  Status send(HeadSubmission& submission);
  Status stop_tasks();
  Status finish_up();
  TaskPlanWish wish(std::int64_t frames) const;
  int tasks_at_once() const;

  /// Of Slurm's controller: what to do when it does not answer.
  Status bear(const Error& error);
  void write_state(const std::vector<QueuedTask>& queue);

  Campaign& campaign_;
  const PreparedCampaign& prepared_;
  SlurmOptions options_;
  RunOptions asked_;
  SlurmCommands commands_;
  SlurmCluster cluster_;
  FrameLedger ledger_;
  TaskBook book_;
  TaskTimes times_;
  std::chrono::steady_clock::time_point last_answer_;
  bool silence_told_ = false;
  int barren_looks_ = 0;  ///< looks in a row at which tasks had ended without having made anything
  bool barren_ = false;   ///< at this look
  std::string last_error_;               ///< of tasks
  std::map<std::string, int> bad_ends_;  ///< by node, in a row
  std::set<std::string> left_out_;       ///< nodes
  bool any_lost_ = false;
  std::string state_;  ///< as it was written last
  std::atomic<int> drains_ = 0;
  std::atomic<bool> ended_ = false;
  FinishStage stage_;
  Collector collector_;
};

}  // namespace seedframe
