// campaign.sqlite: what has been done, tried and measured (docs/formats/job-store.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/twin_tally.h"

namespace seedframe {

enum class FrameState { kPending, kRunning, kDone, kFailed };
const char* to_string(FrameState state);

struct FrameRow {
  std::int64_t frame = 0;  ///< index in the campaign
  std::int64_t scene = 0;
  std::string frame_id;
  FrameState state = FrameState::kPending;
  int attempts = 0;
  std::string pixel_hash;  ///< of all passes; set when done
  std::string error;       ///< of the last failed attempt; empty when done
  TwinTally twin;          ///< set when done
};

struct AttemptRow {
  std::int64_t frame = 0;
  int attempt = 0;
  int worker = 0;
  std::string outcome;    ///< "running", "done", "failed"
  double started = 0.0;   ///< Unix time, seconds
  double build_s = 0.0;   ///< building the scene in Blender
  double render_s = 0.0;  ///< rendering and writing the EXR
  double finish_s = 0.0;  ///< checking, converting, labelling and writing the files
  std::string message;    ///< of a failure
};

struct FrameCounts {
  std::int64_t pending = 0;
  std::int64_t running = 0;
  std::int64_t done = 0;
  std::int64_t failed = 0;
  std::int64_t total() const { return pending + running + done + failed; }
};

struct AttemptTimings {
  double build_s = 0.0;
  double render_s = 0.0;
  double finish_s = 0.0;
};

struct TwinSummary {
  std::int64_t frames = 0;            ///< compared
  std::int64_t frames_differing = 0;  ///< in any pixel
  TwinTally sum;
};

/// One SQLite database in WAL mode with synchronous=FULL: a call that returned survives a power
/// loss. One writer; not for use from several threads at once.
class JobStore {
 public:
  /// Makes a new store; one that exists is an error.
  static Result<JobStore> create(const std::filesystem::path& path);
  /// Opens a store that exists. Not a store, damaged, or of a newer version: an error that says so.
  static Result<JobStore> open(const std::filesystem::path& path);
  ~JobStore();
  JobStore(JobStore&&) noexcept;
  JobStore& operator=(JobStore&&) noexcept;

  Status set_meta(const std::string& key, const std::string& value);
  /// Empty when the key was never set.
  Result<std::string> meta(const std::string& key) const;

  /// Adds frames in state pending, all or none; `next` gives them one by one until nothing is left.
  Status add_frames(const std::function<Result<std::optional<FrameRow>>()>& next);

  /// Frames left in state running by a scheduler that died become pending again.
  Status reset_running();
  /// Makes a frame pending again, whatever it was.
  Status reset(std::int64_t frame);
  /// A frame found complete on disk becomes done.
  Status adopt(std::int64_t frame, const std::string& pixel_hash, const TwinTally& twin);
  Status attempt_started(std::int64_t frame, int attempt, int worker, double unix_time);
  Status frame_done(std::int64_t frame, int attempt, const std::string& pixel_hash,
                    const TwinTally& twin, const AttemptTimings& timings);
  /// The frame becomes failed if `final`, otherwise pending. The attempt need not have started.
  Status attempt_failed(std::int64_t frame, int attempt, const std::string& message, bool final);

  enum class Sync { kNow, kLater };
  /// What `body` writes, in one transaction: all or nothing, and one wait for the disk; with
  /// Sync::kLater none, and a power loss may take it back until something else is written.
  Status write_together(Sync sync, const std::function<Status()>& body);

  Result<FrameCounts> counts() const;
  Result<std::optional<FrameRow>> frame(std::int64_t frame) const;
  /// In the order of frames; stops at the first error of `visit`.
  Status for_each_frame(const std::function<Status(const FrameRow&)>& visit) const;
  /// Up to `most` frames from index `first` on, in order.
  Result<std::vector<FrameRow>> frames_from(std::int64_t first, int most) const;
  Result<std::vector<AttemptRow>> attempts(std::int64_t frame) const;
  /// The newest failures, newest first.
  Result<std::vector<AttemptRow>> recent_failures(int most) const;
  /// Over all frames that are done and were compared with their twins.
  Result<TwinSummary> twin_summary() const;
  /// Mean over the newest `most` attempts that are done; none if there are none.
  Result<std::optional<AttemptTimings>> mean_timings(int most) const;

  /// SHA-256 over "<frame> <frame id> <pixel hash>\n" of all frames in order: what was asked for
  /// and what came of it. Empty until every frame is done.
  Result<std::string> dataset_hash() const;

 private:
  struct Database;
  explicit JobStore(std::unique_ptr<Database> database);
  std::unique_ptr<Database> database_;
};

}  // namespace seedframe
