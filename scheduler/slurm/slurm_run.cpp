#include "slurm/slurm_run.h"

#include <algorithm>
#include <thread>

#include "base/files.h"
#include "slurm/cluster_state.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kCollectThreads = 2;
/// A controller that is restarted is away for minutes at most.
constexpr auto kLongestSilence = std::chrono::minutes(10);
constexpr auto kSilenceToTell = std::chrono::seconds(30);

}  // namespace

SlurmRun::SlurmRun(Campaign& campaign, const PreparedCampaign& prepared, Provenance& provenance,
                   const RunSetup& setup, RunObserver& observer, const SlurmOptions& options,
                   const RunOptions& asked)
    : campaign_(campaign),
      prepared_(prepared),
      options_(options),
      asked_(asked),
      commands_(options_),
      ledger_(asked.pool.attempts),
      book_(campaign.files),
      stage_(campaign, observer, *this, kCollectThreads),
      collector_(campaign.files, provenance, setup.color ? setup.color->config_hash() : "", ledger_,
                 stage_) {}

Result<RunSummary> SlurmRun::run(const std::vector<PendingFrame>& frames) {
  if (Status begun = begin(frames); !begun) return forward_error(begun);
  Status looped = loop();
  while (looped && ledger_.any_settling() && !ended_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const Status closed = stage_.close();
  if (!closed) return forward_error(closed);
  if (!looped) return forward_error(looped);
  return ledger_.summary();
}

Status SlurmRun::begin(const std::vector<PendingFrame>& frames) {
  for (const PendingFrame& frame : frames) {
    const auto row = campaign_.store.frame(frame.frame);
    if (!row) return forward_error(row);
    if (*row) ledger_.add(frame, (*row)->frame_id);
  }
  if (frames.empty()) return stage_.open();
  Result<SlurmCluster> cluster = commands_.cluster();
  if (!cluster) return forward_error(cluster);
  cluster_ = *cluster;
  last_answer_ = std::chrono::steady_clock::now();
  if (Status known = collector_.load_nodes(); !known) return known;
  if (Status opened = stage_.open(); !opened) return opened;
  std::vector<std::string> notes;
  if (Status loaded = book_.load(notes); !loaded) return loaded;
  for (const std::string& note : notes) stage_.note(note);
  for (const auto& submission : book_.submissions()) {
    for (std::size_t i = 0; i < submission->batches.size(); ++i) {
      const HeadBatch& batch = submission->batches[i];
      const int index = static_cast<int>(i);
      if (batch.closed) {
        // Closed by a head that may not have come to collect it.
        const auto taken = collector_.collect(submission->files.closed_results(index), times_);
        if (!taken) return forward_error(taken);
        continue;
      }
      for (const std::int64_t frame : batch.frames) {
        ledger_.give_out(frame, {submission->number, index});
      }
    }
  }
  return {};
}

Status SlurmRun::loop() {
  while (!ended_) {
    const Result<bool> over = look();
    if (!over) return forward_error(over);
    if (*over || drains_ > 1) break;
    sleep();
  }
  return ended_ || drains_ > 1 ? Status() : finish_up();
}

Result<bool> SlurmRun::look() {
  barren_ = false;
  // Before the queue: a task that has begun and waits has been put back into the queue.
  book_.look_for_claims();
  if (Status collected = collect_all(); !collected) return forward_error(collected);
  if (ledger_.all_over()) return true;
  const Result<std::vector<QueuedTask>> queue = commands_.queue();
  if (!queue) {
    if (Status borne = bear(queue.error()); !borne) return forward_error(borne);
    return false;
  }
  last_answer_ = std::chrono::steady_clock::now();
  silence_told_ = false;
  if (Status found = book_.find_jobs(*queue); !found) return forward_error(found);
  if (Status judged = judge(*queue); !judged) return forward_error(judged);
  if (drains_ > 0) {
    if (Status stopped = stop_tasks(); !stopped) return forward_error(stopped);
    write_state(*queue);
    return book_.open_batches() == 0 && !ledger_.any_settling();
  }
  if (Status hopeful = check_hope(); !hopeful) return forward_error(hopeful);
  if (Status planned = plan(); !planned) return forward_error(planned);
  if (Status sent = send_due(); !sent) return forward_error(sent);
  write_state(*queue);
  return ledger_.all_over();
}

void SlurmRun::sleep() const {
  constexpr auto kStep = std::chrono::milliseconds(50);
  const int drains = drains_;
  const auto until =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(options_.poll_s);
  while (std::chrono::steady_clock::now() < until && drains_ == drains && !ended_) {
    std::this_thread::sleep_for(kStep);
  }
}

Status SlurmRun::bear(const Error& error) {
  const auto silence = std::chrono::steady_clock::now() - last_answer_;
  if (silence > kLongestSilence) {
    return fail(ErrorKind::kEnvironment,
                "Slurm has given no answer for {} minutes: {}. Tasks that run go on, and the next "
                "run collects what they make",
                std::chrono::duration_cast<std::chrono::minutes>(silence).count(), error.message);
  }
  if (silence > kSilenceToTell && !silence_told_) {
    silence_told_ = true;
    stage_.note("Slurm gives no answer, and is asked again: " + error.message);
  }
  return {};
}

Status SlurmRun::collect_all() {
  for (const auto& submission : book_.submissions()) {
    for (std::size_t i = 0; i < submission->batches.size(); ++i) {
      const HeadBatch& batch = submission->batches[i];
      if (batch.closed || !batch.claimed) continue;
      const auto taken = collector_.collect(submission->files.results(static_cast<int>(i)), times_);
      if (!taken) return forward_error(taken);
      if (*taken == 0) continue;
      barren_looks_ = 0;
      bad_ends_.erase(batch.node);
    }
  }
  return {};
}

Status SlurmRun::stop_tasks() {
  for (const auto& submission : book_.submissions()) {
    if (submission->all_closed()) continue;
    if (!submission->job) {
      // Not asked since the queue was looked at: it is not there.
      if (Status closed = close_unstarted(*submission); !closed) return closed;
      continue;
    }
    if (!submission->queued) continue;
    // What cannot be told now is told at the next look.
    (void)commands_.cancel(*submission->job, /*waiting_only=*/true);
    (void)commands_.tell_to_stop(*submission->job);
  }
  return {};
}

Status SlurmRun::finish_up() {
  while (ledger_.any_settling() && !ended_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  if (book_.open_batches() > 0) {
    const std::vector<QueuedTask> queue = commands_.queue().value_or(std::vector<QueuedTask>());
    if (Status found = book_.find_jobs(queue); !found) return found;
  }
  for (const auto& submission : book_.submissions()) {
    if (submission->all_closed()) continue;
    // Every frame has come; what is still there makes frames that somebody else has made.
    if (submission->queued) (void)commands_.cancel(*submission->job, /*waiting_only=*/false);
    for (std::size_t i = 0; i < submission->batches.size(); ++i) {
      HeadBatch& batch = submission->batches[i];
      if (batch.closed) continue;
      const int index = static_cast<int>(i);
      const auto claimed = claim_batch(submission->files, index, {.by_head = true});
      if (!claimed) return forward_error(claimed);
      if (Status closed = close_batch(submission->files, index); !closed) return closed;
      batch.closed = true;
    }
  }
  const RunSummary summary = ledger_.summary();
  book_.remove_closed(/*tidy=*/!any_lost_ && summary.failed + summary.quarantined == 0);
  return {};
}

void SlurmRun::write_state(const std::vector<QueuedTask>& queue) {
  ClusterState state;
  for (const auto& submission : book_.submissions()) {
    if (submission->job && !submission->all_closed()) state.jobs.insert(*submission->job);
  }
  for (const QueuedTask& task : queue) {
    if (!state.jobs.contains(task.job)) continue;
    ++(task.waits ? state.waiting : state.running);
    if (!task.waits) state.nodes.insert(task.node);
  }
  state.frames = ledger_.out();
  state.left_out = left_out_;
  std::string text = readable_json(to_json(state));
  if (text == state_) return;
  // Only for whoever looks.
  if (write_file_atomically(campaign_.files.slurm_state(), text)) state_ = std::move(text);
}

}  // namespace seedframe
