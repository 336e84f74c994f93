// Commits: brings finished frames to the disk and into place, and then into the job store.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "frames/campaign_files.h"
#include "render/frame_job.h"
#include "store/job_store.h"

namespace seedframe {

/// Which folder a campaign has, so that it is seen when that was moved or replaced.
class FolderIdentity {
 public:
  explicit FolderIdentity(std::filesystem::path folder);
  /// kEnvironment: another folder, or none, has its path now.
  Status check() const;

 private:
  std::filesystem::path folder_;
  std::pair<std::uint64_t, std::uint64_t> identity_;  ///< device and inode
};

/// Gives the folder of a finished attempt the frame's name, without a wait for the disk; the
/// fingerprint of the frame in its place.
Result<std::string> put_into_place(const CampaignFiles& files, const std::filesystem::path& attempt,
                                   std::int64_t frame);

struct AttemptStarted {
  FrameJob job;
  int worker = 0;
  double unix_time = 0.0;
  std::string provenance = {};  ///< see JobStore::attempt_started
};

struct AttemptFailed {
  FrameJob job;
  AttemptFailure failure;
};

struct FrameFinished {
  FrameJob job;
  std::string pixel_hash;
  TwinTally twin;
  AttemptTimings timings;
};

using StoreEvent = std::variant<AttemptStarted, AttemptFailed, FrameFinished>;

/// A thread that writes what happens in a run, in order. Waiting for the disk takes as long as
/// rendering a small frame, so nobody else waits, and what came meanwhile is written together: one
/// wait for all files, one for the store. A row says "done" only when the frame's folder has its
/// final name and is on the disk; a folder gets its final name only while the store confirms that
/// the run still owns the campaign and that the attempt is the one under way, or else it is
/// dropped. The destructor writes what is left.
class StoreWriter {
 public:
  /// `on_written` is called from the thread for each event, with the outcome of its batch.
  using OnWritten = std::function<void(const StoreEvent&, const Status&)>;

  /// Uses `store` alone as long as it lives.
  StoreWriter(CampaignFiles files, JobStore& store, OnWritten on_written);
  ~StoreWriter();
  StoreWriter(const StoreWriter&) = delete;
  StoreWriter& operator=(const StoreWriter&) = delete;

  /// From any thread; returns at once.
  void push(StoreEvent event);

 private:
  void work();
  Status write(const std::vector<StoreEvent>& events);
  Status write_rows(const std::vector<StoreEvent>& events);
  /// Places and stores a frame; false if its attempt may not commit, which changes nothing.
  Result<bool> commit(const FrameFinished& event);

  CampaignFiles files_;
  FolderIdentity root_;
  JobStore& store_;
  OnWritten on_written_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<StoreEvent> events_;
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace seedframe
