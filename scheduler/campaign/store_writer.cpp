#include "campaign/store_writer.h"

#include <algorithm>
#include <utility>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

struct WriteRow {
  JobStore& store;

  Status operator()(const AttemptStarted& event) const {
    return store.attempt_started(event.job.frame, event.job.attempt, event.worker, event.unix_time);
  }
  Status operator()(const AttemptFailed& event) const {
    return store.attempt_failed(event.job.frame, event.job.attempt, event.message, event.final);
  }
  Status operator()(const FrameFinished& event) const {
    return store.frame_done(event.job.frame, event.job.attempt, event.pixel_hash, event.twin,
                            event.timings);
  }
};

}  // namespace

StoreWriter::StoreWriter(CampaignFiles files, JobStore& store, OnWritten on_written)
    : files_(std::move(files)),
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
  bool any_finished = false;
  for (const StoreEvent& event : events) {
    const auto* finished = std::get_if<FrameFinished>(&event);
    if (finished == nullptr) continue;
    if (Status placed = put_into_place(finished->job); !placed) return placed;
    any_finished = true;
  }
  // After the renames, so that one wait is for them too. Should the power fail before it, resume
  // finds a folder without a row, and believes it only after comparing it with its manifest.
  if (any_finished) {
    if (Status synced = sync_filesystem(files_.frames()); !synced) return synced;
  }
  // That an attempt began is lost with the attempt itself: not worth a wait.
  const bool only_started = std::all_of(events.begin(), events.end(), [](const StoreEvent& event) {
    return std::holds_alternative<AttemptStarted>(event);
  });
  const auto sync = only_started ? JobStore::Sync::kLater : JobStore::Sync::kNow;
  return store_.write_together(sync, [&]() -> Status {
    for (const StoreEvent& event : events) {
      if (Status row = std::visit(WriteRow{store_}, event); !row) return row;
    }
    return {};
  });
}

Status StoreWriter::put_into_place(const FrameJob& job) const {
  const fs::path folder = files_.frame(job.frame);
  if (Status made = make_folders(folder.parent_path()); !made) return made;
  // An earlier attempt may have been rejected; this one was not.
  std::error_code ignored;
  fs::remove_all(files_.rejected(job.frame), ignored);
  return replace_folder(files_.attempt(job.frame, job.attempt), folder);
}

}  // namespace seedframe
