#include "campaign/label_run.h"

#include "base/clock.h"
#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;

LabelRun::LabelRun(Campaign& campaign, PreparedCampaign& prepared, Provenance& provenance,
                   const RunSetup& setup, RunObserver& observer)
    : campaign_(campaign),
      prepared_(prepared),
      provenance_(provenance),
      observer_(observer),
      frames_at_once_(setup.options.pool.workers),
      finisher_(prepared.settings.categories, prepared.settings.twin_check,
                setup.options.pool.worker.threads),
      writer_(std::make_unique<StoreWriter>(
          campaign.files, campaign.store,
          [this](const StoreEvent& event, const Status& status) { written(event, status); })),
      queue_(std::make_unique<FinishQueue>(frames_at_once_)) {}

LabelRun::~LabelRun() {
  queue_.reset();
  writer_.reset();
}

Result<RunSummary> LabelRun::run(const std::vector<PendingFrame>& frames) {
  if (Status made = prepare_folders(); !made) return forward_error(made);
  Result<std::string> made_with = provenance_.of_twin();
  if (!made_with) return forward_error(made_with);
  made_with_ = std::move(*made_with);
  std::int64_t begun = 0;
  for (const PendingFrame& pending : frames) {
    if (drained_) break;
    begin({pending.frame, pending.attempts_used + 1});
    ++begun;
  }
  queue_.reset();   // waits for what is being traced
  writer_.reset();  // and what is being written
  std::error_code ignored;
  fs::remove_all(campaign_.files.work(), ignored);
  if (!error_) return forward_error(error_);
  summary_.left = static_cast<std::int64_t>(frames.size()) - begun;
  return summary_;
}

Status LabelRun::prepare_folders() const {
  for (const fs::path& folder : {campaign_.files.work() / "attempts", campaign_.files.frames()}) {
    if (Status made = make_folders(folder); !made) return made;
  }
  return {};
}

void LabelRun::begin(const FrameJob& job) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return under_way_ < 2 * frames_at_once_; });
    ++under_way_;
  }
  writer_->push(AttemptStarted{job, 0, unix_time(), made_with_});
  Result<ExpandedFrame> expanded = prepared_.expander.expand(job.frame);
  const fs::path folder = campaign_.files.attempt(job.frame, job.attempt);
  const Status made = expanded ? make_folders(folder) : Status(forward_error(expanded));
  if (!made) {
    give_up(job, made.error());
    return;
  }
  FinishTask task{std::move(expanded->spec), std::move(expanded->id), std::move(expanded->meshes),
                  folder, campaign_.files.rejected(job.frame)};
  queue_->push([this, job, task = std::move(task)] { finish(job, task); });
}

void LabelRun::finish(const FrameJob& job, const FinishTask& task) {
  const auto start = std::chrono::steady_clock::now();
  const Result<FinishedFrame> finished = finisher_.finish_by_twin(task);
  const std::chrono::duration<double> finish_time = std::chrono::steady_clock::now() - start;
  if (!finished) {
    std::error_code ignored;
    fs::remove_all(task.attempt_folder, ignored);
    give_up(job, finished.error());
    return;
  }
  writer_->push(
      FrameFinished{job, finished->pixel_hash, finished->twin, {0.0, 0.0, finish_time.count()}});
}

void LabelRun::give_up(const FrameJob& job, const Error& error) {
  const bool of_the_system =
      error.kind == ErrorKind::kEnvironment || error.kind == ErrorKind::kExhausted;
  if (!of_the_system) {  // the same would come of every further attempt
    writer_->push(
        AttemptFailed{job, {Failure::kAnswered, Consequence::kFailed, error.message, {}}});
    return;
  }
  const std::lock_guard lock(mutex_);
  if (error_) error_ = tl::unexpected(error);
  drained_ = true;
  --under_way_;
  changed_.notify_one();
}

void LabelRun::written(const StoreEvent& event, const Status& status) {
  const auto* finished = std::get_if<FrameFinished>(&event);
  const auto* failed = std::get_if<AttemptFailed>(&event);
  if (finished != nullptr && status) observer_.frame_done(finished->job.frame);
  if (failed != nullptr) observer_.attempt_failed(failed->job, failed->failure);
  const std::lock_guard lock(mutex_);
  if (!status) {
    if (error_) error_ = status;
    drained_ = true;
  }
  if (finished == nullptr && failed == nullptr) return;
  --under_way_;
  (failed == nullptr ? summary_.committed : summary_.failed) += 1;
  changed_.notify_one();
}

}  // namespace seedframe
