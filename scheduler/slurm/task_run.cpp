#include "slurm/task_run.h"

#include <atomic>
#include <cstdio>
#include <thread>

#include "base/clock.h"
#include "base/files.h"
#include "base/machine_folder.h"
#include "campaign/campaign_runner.h"
#include "campaign/drain_signals.h"
#include "scene/prepared_campaign.h"
#include "slurm/delivery.h"
#include "slurm/submission.h"
#include "slurm/task_frame.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Slurm kills what has not ended 30 s after scancel (KillWait), unless told otherwise.
constexpr auto kTimeToFinish = std::chrono::seconds(20);

/// Ends what is still under way some time after the run was told to stop.
class DropWhenLate {
 public:
  explicit DropWhenLate(CampaignRunner& runner)
      : thread_([&runner](const std::stop_token& stop) { watch(runner, stop); }) {}

 private:
  static void watch(CampaignRunner& runner, const std::stop_token& stop) {
    std::chrono::steady_clock::time_point told{};
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      if (!runner.is_drained()) continue;
      const auto now = std::chrono::steady_clock::now();
      if (told == std::chrono::steady_clock::time_point()) told = now;
      if (now - told < kTimeToFinish) continue;
      runner.drain();  // once more: the workers are ended
      return;
    }
  }
  std::jthread thread_;
};

class Task {
 public:
  Task(const TaskOrder& order, const Submission& submission, SubmissionFiles files)
      : order_(order), submission_(submission), files_(std::move(files)) {}

  /// Whether it was told to stop.
  Result<bool> run();

 private:
  Result<PreparedCampaign> prepare_frames(const MachineFolder& node) const;
  Result<RunSetup> set_up(const CampaignSettings& settings, const MachineFolder& node) const;
  const std::vector<std::int64_t>& frames() const {
    return submission_.batches[static_cast<std::size_t>(order_.batch)];
  }

  const TaskOrder& order_;
  const Submission& submission_;
  SubmissionFiles files_;
  double started_ = unix_time();
};

Result<PreparedCampaign> Task::prepare_frames(const MachineFolder& node) const {
  CampaignSource source = submission_.source;
  source.copies = node.assets();
  Result<PreparedCampaign> prepared = prepare(std::move(source));
  if (!prepared) return prepared;
  if (submission_.choices) prepared->expander.set_choices(submission_.choices);
  return prepared;
}

Result<RunSetup> Task::set_up(const CampaignSettings& settings, const MachineFolder& node) const {
  Result<RunOptions> options = options_of_tasks(submission_.run, files_.submission().string());
  if (!options) return forward_error(options);
  options->cores = order_.cpus;
  options->meshes = node.meshes();
  options->no_cache = true;
  options->pause_limit_s = 0.0;  // nobody makes room on a node: the head tries another one
  options->worker.ignores_terminate = true;
  RunPlaces places = order_.places;
  places.cache.clear();
  return set_up_run(std::move(*options), places, settings,
                    static_cast<std::int64_t>(frames().size()));
}

Result<bool> Task::run() {
  const Result<MachineFolder> node = MachineFolder::open(submission_.node_folder);
  if (!node) return forward_error(node);
  Result<PreparedCampaign> prepared = prepare_frames(*node);
  if (!prepared) return forward_error(prepared);
  const Result<RunSetup> setup = set_up(prepared->settings, *node);
  if (!setup) return forward_error(setup);
  const Result<MachineFolder::Own> own = node->make_own();
  if (!own) return forward_error(own);
  UsedFiles used;
  Result<Campaign> campaign = create_scratch_campaign(own->folder(), frames(), *prepared, used);
  if (!campaign) return forward_error(campaign);
  std::vector<PendingFrame> pending;
  for (const std::int64_t frame : frames()) {
    const auto crashes = submission_.crashes.find(frame);
    pending.push_back({frame, 0, crashes == submission_.crashes.end() ? 0 : crashes->second});
  }
  Delivery delivery(*campaign, files_.results(order_.batch),
                    {order_.node, started_, setup->options.pool.workers});
  CampaignRunner runner(*campaign, *prepared, used, *setup, delivery);
  delivery.on_error([&runner] { runner.drain(); });
  const DrainOnSignals drain(runner);
  const DropWhenLate drop(runner);
  const Result<RunSummary> summary = runner.run_to_end(std::move(pending));
  if (Status delivered = delivery.close(); !delivered) return forward_error(delivered);
  if (!summary) return forward_error(summary);
  return runner.is_drained();
}

}  // namespace

Result<std::string> run_task(const TaskOrder& order) {
  const SubmissionFiles files(order.submission);
  const Result<Submission> submission = read_submission(files);
  if (!submission) return forward_error(submission);
  if (order.batch < 0 || static_cast<std::size_t>(order.batch) >= submission->batches.size()) {
    return fail(ErrorKind::kInput, "{} has no batch {}", files.root().string(), order.batch);
  }
  const auto claimed = claim_batch(files, order.batch, {order.node, order.task});
  if (!claimed) return forward_error(claimed);
  if (*claimed == ClaimOutcome::kTaken) {
    const auto claim = read_claim(files, order.batch);
    return fmt::format("batch {} is not for us: {} has taken it, as {}", order.batch,
                       claim->by_head ? "the head" : claim->node,
                       claim->by_head ? "it was given up" : "task " + claim->task);
  }
  const fs::path results = files.results(order.batch);
  std::error_code error;
  fs::create_directory(results, error);
  if (error) return system_failure("create", results, error.value());
  Result<bool> stopped = Task(order, *submission, files).run();
  TaskEnd end{stopped && *stopped, stopped ? Error() : stopped.error()};
  // A folder that is gone was closed by the head, which has given the batch up.
  const Status told =
      write_file_atomically(results / batch_files::kEnd, canonical_json(to_json(end)));
  if (!stopped) return forward_error(stopped);
  if (!told) return forward_error(told);
  return fmt::format("batch {} is over{}", order.batch, *stopped ? ": it was told to stop" : "");
}

}  // namespace seedframe
