#include "campaign/store_writer.h"

#include <algorithm>
#include <utility>

#include <pthread.h>
#include <sys/stat.h>

#include "base/files.h"
#include "frames/frame_fingerprint.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

FrameState next_state(Consequence consequence) {
  switch (consequence) {
    case Consequence::kFailed:
      return FrameState::kFailed;
    case Consequence::kQuarantined:
      return FrameState::kQuarantined;
    case Consequence::kRetry:
      break;
  }
  return FrameState::kPending;
}

Status write_failure(JobStore& store, const AttemptFailed& event) {
  const auto outcome =
      event.failure.failure == Failure::kCrash ? AttemptOutcome::kCrash : AttemptOutcome::kError;
  return store.attempt_failed(event.job.frame, event.job.attempt, outcome,
                              next_state(event.failure.consequence), event.failure.message);
}

/// Which folder it is, wherever it is moved to; zeros if there is none.
std::pair<std::uint64_t, std::uint64_t> identity(const fs::path& folder) {
  struct stat info = {};
  if (::stat(folder.c_str(), &info) != 0) return {};
  return {info.st_dev, info.st_ino};
}

}  // namespace

FolderIdentity::FolderIdentity(fs::path folder)
    : folder_(std::move(folder)), identity_(identity(folder_)) {}

Status FolderIdentity::check() const {
  if (identity(folder_) == identity_) return {};
  return fail(ErrorKind::kEnvironment,
              "{} is not the folder that this run began with: it was moved or replaced meanwhile",
              folder_.string());
}

StoreWriter::StoreWriter(CampaignFiles files, JobStore& store, OnWritten on_written)
    : files_(std::move(files)),
      root_(files_.root()),
      store_(store),
      on_written_(std::move(on_written)),
      thread_([this] { work(); }) {}

StoreWriter::~StoreWriter() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void StoreWriter::push(StoreEvent event) {
  {
    const std::lock_guard lock(mutex_);
    events_.push_back(std::move(event));
  }
  changed_.notify_one();
}

void StoreWriter::work() {
  pthread_setname_np(pthread_self(), "store");  // for whoever looks at what costs time
  while (true) {
    std::vector<StoreEvent> events;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return closed_ || !events_.empty(); });
      if (events_.empty()) return;
      events.swap(events_);
    }
    const Status written = write(events);
    for (const StoreEvent& event : events) on_written_(event, written);
  }
}

Status StoreWriter::write(const std::vector<StoreEvent>& events) {
  if (Status there = root_.check(); !there) return there;
  // That an attempt began is lost with the attempt itself: not worth a wait.
  const bool only_started = std::all_of(events.begin(), events.end(), [](const StoreEvent& event) {
    return std::holds_alternative<AttemptStarted>(event);
  });
  const auto sync = only_started ? JobStore::Sync::kLater : JobStore::Sync::kNow;
  // The renames are inside the transaction: nobody can take the campaign over between the question
  // whether an attempt may commit and its commit.
  return store_.write_together(sync, [&] { return write_rows(events); });
}

Status StoreWriter::write_rows(const std::vector<StoreEvent>& events) {
  bool any_finished = false;
  for (const StoreEvent& event : events) {
    if (const auto* started = std::get_if<AttemptStarted>(&event)) {
      const auto& [job, worker, unix_time, provenance] = *started;
      Status row = store_.attempt_started(job.frame, job.attempt, worker, unix_time, provenance);
      if (!row) return row;
    } else if (const auto* failed = std::get_if<AttemptFailed>(&event)) {
      if (Status row = write_failure(store_, *failed); !row) return row;
    } else {
      const Result<bool> committed = commit(std::get<FrameFinished>(event));
      if (!committed) return forward_error(committed);
      any_finished = any_finished || *committed;
    }
  }
  // After the renames, so that one wait is for them too, and before the rows count. Should the
  // power fail before it, resume finds a folder without a row, and believes it only after comparing
  // it with its manifest.
  return any_finished ? sync_filesystem(files_.frames()) : Status();
}

Result<bool> StoreWriter::commit(const FrameFinished& event) {
  const auto& [frame, attempt] = event.job;
  auto under_way = store_.is_under_way(frame, attempt);
  if (!under_way || !*under_way) return under_way;  // late, or said twice
  const Result<std::string> fingerprint =
      put_into_place(files_, files_.attempt(frame, attempt), frame);
  if (!fingerprint) return forward_error(fingerprint);
  Status row = store_.frame_done(frame, attempt, {event.pixel_hash, *fingerprint, event.twin},
                                 event.timings);
  if (!row) return forward_error(row);
  return true;
}

Result<std::string> put_into_place(const CampaignFiles& files, const fs::path& attempt,
                                   std::int64_t frame) {
  const fs::path folder = files.frame(frame);
  if (Status made = make_folders_in(files.root(), folder.parent_path()); !made)
    return forward_error(made);
  // An earlier attempt may have been rejected; this one was not.
  std::error_code ignored;
  fs::remove_all(files.rejected(frame), ignored);
  // What somebody put in its place; of a link, not its target, which is not ours.
  if (fs::symlink_status(folder, ignored).type() != fs::file_type::directory) {
    fs::remove(folder, ignored);
  }
  if (Status placed = replace_folder(attempt, folder); !placed) {
    return forward_error(placed);
  }
  return frame_fingerprint(folder);
}

}  // namespace seedframe
