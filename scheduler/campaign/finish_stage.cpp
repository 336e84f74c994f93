#include "campaign/finish_stage.h"

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;

FinishStage::~FinishStage() {
  queue_.reset();
  writer_.reset();
}

Status FinishStage::open() {
  const CampaignFiles& files = campaign_.files;
  for (const fs::path& folder : {files.work() / "attempts", files.frames()}) {
    if (Status made = make_folders_in(files.root(), folder); !made) return made;
  }
  writer_ = std::make_unique<StoreWriter>(
      files, campaign_.store,
      [this](const StoreEvent& event, const Status& status) { written(event, status); });
  queue_ = std::make_unique<FinishQueue>(threads_);
  return {};
}

void FinishStage::begin(const FrameJob& job, int worker, const std::string& provenance,
                        double started) {
  writer_->push(AttemptStarted{job, worker, started, provenance});
}

void FinishStage::fail(const FrameJob& job, AttemptFailure failure) {
  std::error_code ignored;
  fs::remove_all(campaign_.files.attempt(job.frame, job.attempt), ignored);
  fs::remove_all(campaign_.files.workers() / CampaignFiles::attempt_name(job.frame, job.attempt),
                 ignored);
  writer_->push(AttemptFailed{job, std::move(failure)});
}

void FinishStage::end(const Error& error) {
  {
    const std::lock_guard lock(mutex_);
    if (outcome_) outcome_ = tl::unexpected(error);
  }
  client_.ends();
}

void FinishStage::note(const std::string& text) {
  const std::lock_guard lock(observer_mutex_);
  observer_.noted(text);
}

Status FinishStage::close() {
  queue_.reset();   // waits for what is being finished
  writer_.reset();  // and what is being written
  std::error_code ignored;
  fs::remove_all(campaign_.files.work(), ignored);
  return outcome_;
}

void FinishStage::written(const StoreEvent& event, const Status& status) {
  if (!status) end(status.error());
  if (const auto* finished = std::get_if<FrameFinished>(&event)) {
    if (status) {
      const std::lock_guard lock(observer_mutex_);
      observer_.frame_done(finished->job.frame);
    }
    client_.frame_written(finished->job, status);
  }
  if (const auto* failed = std::get_if<AttemptFailed>(&event)) {
    {
      const std::lock_guard lock(observer_mutex_);
      observer_.attempt_failed(failed->job, failed->failure);
    }
    client_.failure_written(failed->job);
  }
}

}  // namespace seedframe
