#include "slurm/delivery.h"

#include <algorithm>
#include <cstdio>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// On the disk, but for the new folder's own entry.
Status copy_folder(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::remove_all(to, error);
  fs::create_directory(to, error);
  if (error) return system_failure("create", to, error.value());
  for (const fs::directory_entry& entry : fs::directory_iterator(from, error)) {
    if (!entry.is_regular_file(error)) continue;
    const Result<std::string> bytes = read_file(entry.path());
    if (!bytes) return forward_error(bytes);
    if (Status written = write_file(to / entry.path().filename(), *bytes); !written) {
      return written;
    }
  }
  if (error) return system_failure("list", from, error.value());
  return sync_path(to);
}

/// The folder appears under its name with all that is in it.
Status bring_folder(const fs::path& from, const fs::path& to) {
  const fs::path part = to.string() + ".part";
  if (Status copied = copy_folder(from, part); !copied) return copied;
  return commit_folder(part, to);
}

}  // namespace

Delivery::Delivery(Campaign& campaign, fs::path results, TaskFacts task)
    : campaign_(campaign),
      results_(std::move(results)),
      task_(std::move(task)),
      queue_(std::make_unique<FinishQueue>(1)) {}

Delivery::~Delivery() = default;

Status Delivery::close() {
  queue_.reset();
  const std::lock_guard lock(mutex_);
  return status_;
}

void Delivery::frame_done(std::int64_t frame) { push(frame, FrameState::kDone); }

void Delivery::attempt_failed(const FrameJob& job, const AttemptFailure& failure) {
  std::fprintf(stderr, "frame %lld, attempt %d: %s\n", static_cast<long long>(job.frame),
               job.attempt, failure.message.c_str());
  if (failure.consequence == Consequence::kRetry) return;
  push(job.frame, failure.consequence == Consequence::kFailed ? FrameState::kFailed
                                                              : FrameState::kQuarantined);
}

void Delivery::noted(const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); }

void Delivery::push(std::int64_t frame, FrameState state) {
  Result<TaskFrame> record = record_of(frame, state);
  if (!record) return fail_with(record.error());
  queue_->push([this, record = std::move(*record)] {
    if (Status delivered = deliver(record); !delivered) fail_with(delivered.error());
  });
}

Result<TaskFrame> Delivery::record_of(std::int64_t frame, FrameState state) {
  const auto row = campaign_.store.frame(frame);
  if (!row) return forward_error(row);
  auto attempts = campaign_.store.attempts(frame);
  if (!attempts) return forward_error(attempts);
  for (AttemptRow& attempt : *attempts) {
    if (first_frame_ == 0.0) first_frame_ = attempt.started;
    // Its logs are at the head's by the time that somebody reads this.
    const std::string here = campaign_.files.root().string() + "/";
    for (std::size_t at; (at = attempt.message.find(here)) != std::string::npos;) {
      attempt.message.erase(at, here.size());
    }
  }
  return TaskFrame{
      frame,         *row ? (*row)->frame_id : std::string(),     state,     std::move(*attempts),
      task_.workers, std::max(0.0, first_frame_ - task_.started), task_.node};
}

Status Delivery::deliver(const TaskFrame& record) {
  if (record.state == FrameState::kDone) {
    const fs::path made = campaign_.files.frame(record.frame);
    Status brought = bring_folder(made, results_ / batch_files::frame(record.frame));
    if (!brought) return brought;
    std::error_code ignored;
    fs::remove_all(made, ignored);
  }
  if (Status brought = deliver_evidence(record); !brought) return brought;
  return write_file_atomically(results_ / batch_files::record(record.frame),
                               canonical_json(to_json(record)));
}

Status Delivery::deliver_evidence(const TaskFrame& record) {
  std::error_code missing;
  const fs::path rejected = campaign_.files.rejected(record.frame);
  if (fs::exists(rejected, missing)) {
    Status brought = bring_folder(rejected, results_ / batch_files::rejected(record.frame));
    if (!brought) return brought;
  }
  for (const AttemptRow& attempt : record.attempts) {
    const fs::path log = campaign_.files.crash_log(record.frame, attempt.attempt);
    if (!fs::exists(log, missing)) continue;
    const Result<std::string> words = read_file(log);
    if (!words) return forward_error(words);
    Status written = write_file(results_ / batch_files::log(record.frame, attempt.attempt), *words);
    if (!written) return written;
  }
  return {};
}

void Delivery::fail_with(const Error& error) {
  {
    const std::lock_guard lock(mutex_);
    if (!status_) return;
    status_ = tl::unexpected(error);
  }
  if (tell_) tell_();
}

}  // namespace seedframe
