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
#include "spec/twin_check.h"
#include "store/dataset_hash.h"

namespace seedframe {

enum class FrameState { kPending, kRunning, kDone, kFailed, kQuarantined };
const char* to_string(FrameState state);

enum class AttemptOutcome {
  kRunning,
  kDone,
  kError,  ///< the worker lived on, or wrote a file that was refused
  kCrash,  ///< it cost a worker
  kLost,   ///< its scheduler died
};
const char* to_string(AttemptOutcome outcome);

struct FrameRow {
  std::int64_t frame = 0;  ///< index in the campaign
  std::int64_t scene = 0;
  std::string frame_id;
  FrameState state = FrameState::kPending;
  int attempts = 0;
  int crashes = 0;          ///< of these; a quarantined frame that is asked for again begins anew
  std::string pixel_hash;   ///< of all passes; set when done
  std::string fingerprint;  ///< of its files (frames/frame_fingerprint.h); set when done
  std::string error;        ///< of the last failed attempt; empty when done
  TwinTally twin;           ///< set when done
};

/// Of attempts that no worker made: the frame was there already (cache/frame_cache.h).
inline constexpr int kNoWorker = -1;

struct AttemptRow {
  std::int64_t frame = 0;
  int attempt = 0;
  int worker = 0;  ///< or kNoWorker
  AttemptOutcome outcome = AttemptOutcome::kRunning;
  double started = 0.0;    ///< Unix time, seconds
  double build_s = 0.0;    ///< building the scene in Blender
  double render_s = 0.0;   ///< rendering and writing the EXR
  double finish_s = 0.0;   ///< checking, converting, labelling and writing the files
  std::string message;     ///< of a failure
  std::string provenance;  ///< with what it was made, JSON; empty when nobody knew
};

struct FrameCounts {
  std::int64_t pending = 0;
  std::int64_t running = 0;
  std::int64_t done = 0;
  std::int64_t failed = 0;
  std::int64_t quarantined = 0;
  std::int64_t total() const { return pending + running + done + failed + quarantined; }
};

struct AttemptTimings {
  double build_s = 0.0;
  double render_s = 0.0;
  double finish_s = 0.0;
};

/// A worker of a run, and what came of it.
struct WorkerRow {
  int worker = 0;
  std::int64_t done = 0;
  std::int64_t failed = 0;            ///< attempts
  double frame_s = 0.0;               ///< mean of its frames that are done: building and rendering
  std::optional<std::int64_t> frame;  ///< that it is at: the first of those that it was given
  double since = 0.0;                 ///< when that began, Unix time, seconds
};

/// Of the last run.
struct RunProgress {
  double began = 0.0;     ///< its first attempt, Unix time, seconds; 0: there is none yet
  std::int64_t done = 0;  ///< frames that workers made
  std::vector<WorkerRow> workers;
};

struct TwinSummary {
  std::int64_t frames = 0;            ///< compared
  std::int64_t frames_differing = 0;  ///< in any pixel
  TwinTally sum;
};

/// What a finished frame leaves in the store.
struct FrameResult {
  std::string pixel_hash;
  std::string fingerprint;
  TwinTally twin;
};

/// One SQLite database in WAL mode with synchronous=FULL: a call that returned survives a power
/// loss. One writer, which is fenced: after begin_run, every write looks whether another run has
/// begun since, and is refused then. Not for use from several threads at once.
class JobStore {
 public:
  /// Makes a new store; one that exists is an error. It counts only under its final name: see
  /// create_campaign.
  static Result<JobStore> create(const std::filesystem::path& path);
  /// Opens a store that exists; in a folder that cannot be written only for reading. Not a store,
  /// damaged, or of a newer version: an error that says so.
  static Result<JobStore> open(const std::filesystem::path& path);
  ~JobStore();
  JobStore(JobStore&&) noexcept;
  JobStore& operator=(JobStore&&) noexcept;

  Status set_meta(const std::string& key, const std::string& value);
  /// Empty when the key was never set.
  Result<std::string> meta(const std::string& key) const;

  /// Adds frames in state pending, all or none; `next` gives them one by one until nothing is left.
  Status add_frames(const std::function<Result<std::optional<FrameRow>>()>& next);

  /// From here on this store belongs to a new run; what an older one still writes is refused.
  /// Frames left in state running by a scheduler that died become pending again.
  Status begin_run(double unix_time, const std::string& host, std::int64_t process);
  /// Makes a frame pending again, whatever it was, its crashes forgotten.
  Status reset(std::int64_t frame);
  /// The same, with a new identity: what it depends on has changed.
  Status renew(std::int64_t frame, const std::string& frame_id);
  /// A frame found complete on disk becomes done.
  Status adopt(std::int64_t frame, const FrameResult& result);
  Status set_fingerprint(std::int64_t frame, const std::string& fingerprint);
  /// `provenance` is canonical JSON, or empty; each is stored once.
  Status attempt_started(std::int64_t frame, int attempt, int worker, double unix_time,
                         const std::string& provenance = {});
  /// Whether this attempt may commit: no other has begun, and it has not ended.
  Result<bool> is_under_way(std::int64_t frame, int attempt) const;
  /// Of an attempt that is under way; of any other a kCorrupt error.
  Status frame_done(std::int64_t frame, int attempt, const FrameResult& result,
                    const AttemptTimings& timings);
  /// `outcome` is kError or kCrash, `next` what the frame becomes: pending, failed or quarantined.
  /// The attempt need not have started. Of one that has ended, or is not the frame's last, nothing
  /// is written.
  Status attempt_failed(std::int64_t frame, int attempt, AttemptOutcome outcome, FrameState next,
                        const std::string& message);

  enum class Sync { kNow, kLater };
  /// What `body` writes, in one transaction: all or nothing, and one wait for the disk; with
  /// Sync::kLater none, and a power loss may take it back until something else is written.
  Status write_together(Sync sync, const std::function<Status()>& body);

  /// Reads all of the store; kCorrupt if SQLite finds it damaged.
  Status check_integrity() const;
  Result<FrameCounts> counts() const;
  Result<std::optional<FrameRow>> frame(std::int64_t frame) const;
  /// In the order of frames; stops at the first error of `visit`.
  Status for_each_frame(const std::function<Status(const FrameRow&)>& visit) const;
  /// Up to `most` frames from index `first` on, in order.
  Result<std::vector<FrameRow>> frames_from(std::int64_t first, int most) const;
  /// Up to `most` frames in this state, in order.
  Result<std::vector<FrameRow>> frames_in(FrameState state, int most) const;
  Result<std::vector<AttemptRow>> attempts(std::int64_t frame) const;
  /// Of all frames, in the order of frames and attempts; stops at the first error of `visit`.
  Status for_each_attempt(const std::function<Status(const AttemptRow&)>& visit) const;
  /// Frames of the last good attempts that were begun by the same worker before this one, at most
  /// `most`, oldest first. (Runs number their workers alike: of an earlier run some may be
  /// another's.)
  Result<std::vector<std::int64_t>> done_by_worker_before(const AttemptRow& attempt,
                                                          int most) const;
  /// What attempts were made with: each distinct one, oldest first.
  Result<std::vector<std::string>> provenances() const;
  /// The newest errors and crashes, newest first.
  Result<std::vector<AttemptRow>> recent_failures(int most) const;
  Result<RunProgress> run_progress() const;
  /// The newest good attempts, newest first.
  Result<std::vector<AttemptRow>> recent_done(int most) const;
  /// Changes whenever another process writes, and with nothing else: cheap to ask.
  Result<std::int64_t> data_version() const;
  /// Process that began the last run; none: there was none.
  Result<std::optional<std::int64_t>> last_process() const;
  /// Over all frames that are done and were compared with their twins.
  Result<TwinSummary> twin_summary() const;
  /// Mean over the newest `most` attempts that are done; none if there are none.
  Result<std::optional<AttemptTimings>> mean_timings(int most) const;

  /// What was asked for and what came of it (DatasetHasher). Empty until every frame is done.
  Result<std::string> dataset_hash() const;
  Result<std::vector<SceneHash>> scene_hashes() const;

 private:
  struct Database;
  explicit JobStore(std::unique_ptr<Database> database);
  std::unique_ptr<Database> database_;
};

}  // namespace seedframe
