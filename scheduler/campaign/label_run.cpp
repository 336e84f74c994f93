#include "campaign/label_run.h"

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;

LabelRun::LabelRun(Campaign& campaign, const PreparedCampaign& prepared, Provenance& provenance,
                   const RunSetup& setup, RunObserver& observer)
    : campaign_(campaign),
      prepared_(prepared),
      provenance_(provenance),
      frames_at_once_(setup.options.pool.workers),
      finisher_(prepared.settings.categories, prepared.settings.twin_check,
                setup.options.worker.threads),
      stage_(campaign, observer, *this, frames_at_once_) {}

Result<RunSummary> LabelRun::run(const std::vector<PendingFrame>& frames) {
  const Result<std::string> made_with = provenance_.of_twin();
  if (!made_with) return forward_error(made_with);
  if (Status opened = stage_.open(); !opened) return forward_error(opened);
  std::int64_t begun = 0;
  for (const PendingFrame& pending : frames) {
    if (drained_) break;
    begin({pending.frame, pending.attempts_used + 1}, *made_with);
    ++begun;
  }
  if (Status ended = stage_.close(); !ended) return forward_error(ended);
  summary_.left = static_cast<std::int64_t>(frames.size()) - begun;
  return summary_;
}

void LabelRun::begin(const FrameJob& job, const std::string& made_with) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return under_way_ < 2 * frames_at_once_; });
    ++under_way_;
  }
  stage_.begin(job, 0, made_with);
  Result<ExpandedFrame> expanded = prepared_.expander.expand(job.frame);
  const fs::path folder = campaign_.files.attempt(job.frame, job.attempt);
  const Status made =
      expanded ? make_folders_in(campaign_.files.root(), folder) : Status(forward_error(expanded));
  if (!made) return give_up(job, made.error());
  FinishTask task{std::move(expanded->spec), std::move(expanded->id), std::move(expanded->meshes),
                  folder, campaign_.files.rejected(job.frame)};
  stage_.push([this, job, task = std::move(task)] { finish(job, task); });
}

void LabelRun::finish(const FrameJob& job, const FinishTask& task) {
  const auto start = std::chrono::steady_clock::now();
  const Result<FinishedFrame> finished = finisher_.finish_by_twin(task);
  const std::chrono::duration<double> finish_time = std::chrono::steady_clock::now() - start;
  if (!finished) return give_up(job, finished.error());
  stage_.commit({job, finished->pixel_hash, finished->twin, {0.0, 0.0, finish_time.count()}});
}

void LabelRun::give_up(const FrameJob& job, const Error& error) {
  const bool of_the_system =
      error.kind == ErrorKind::kEnvironment || error.kind == ErrorKind::kExhausted;
  if (of_the_system) {
    stage_.end(error);
    settle(nullptr);
    return;
  }
  // The same would come of every further attempt.
  stage_.fail(job, {Failure::kAnswered, Consequence::kFailed, error.message, {}});
}

void LabelRun::frame_written(const FrameJob&, const Status&) { settle(&RunSummary::committed); }

void LabelRun::failure_written(const FrameJob&) { settle(&RunSummary::failed); }

void LabelRun::settle(std::int64_t RunSummary::*count) {
  const std::lock_guard lock(mutex_);
  --under_way_;
  if (count != nullptr) summary_.*count += 1;
  changed_.notify_one();
}

}  // namespace seedframe
