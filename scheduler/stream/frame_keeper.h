// Keeps the frames that a stream renders: each becomes a frame of a campaign on disk, committed as
// any other, whose values stand in a line of the campaign's own graphs.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/disk_space.h"
#include "campaign/provenance.h"
#include "campaign/store_writer.h"
#include "frames/frame_finisher.h"

namespace seedframe {

/// A rendered frame whose files lie in the folder of its attempt.
struct FrameToKeep {
  std::string graph;  ///< its line, see graph_line
  std::string frame_id;
  UsedFiles used;
  std::filesystem::path attempt;
  FinishedFrame finished;
  AttemptTimings timings;
  int worker = 0;
  double started = 0.0;                  ///< Unix time, seconds
  ReadyMessage made_by;                  ///< what the worker said of itself
  std::vector<AttemptFailure> failures;  ///< of earlier attempts
  /// Told once, from another thread, when the frame is on the disk: its number in the campaign.
  std::function<void(Result<std::int64_t>)> done;
};

class FrameKeeper {
 public:
  /// Makes the campaign, without frames, or goes on with one that a stream of the same config has
  /// made. Nobody else may work on it meanwhile. `prepared` must outlive it. kInput errors: the
  /// folder holds something else; frames that it holds would come out as other ones today.
  static Result<std::unique_ptr<FrameKeeper>> open(const std::filesystem::path& folder,
                                                   const PreparedCampaign& prepared);
  /// Writes what is left.
  ~FrameKeeper();
  FrameKeeper(const FrameKeeper&) = delete;
  FrameKeeper& operator=(const FrameKeeper&) = delete;

  const CampaignFiles& files() const { return campaign_.campaign.files; }
  /// Of the campaign when it was opened, and those of them that are not made.
  std::int64_t frames_before() const { return frames_before_; }
  std::int64_t pending_before() const { return pending_before_; }

  /// Before the first frame is kept.
  Status begin(RunSetup& setup);
  /// kExhausted: no frame should be begun now. From any thread, after begin().
  Status check_room() const;
  /// The same, by writing.
  Status check_disk() const;

  /// From any thread; returns at once. A frame that the campaign has already is not kept twice. One
  /// that cannot be written is an error of that frame alone.
  void keep(FrameToKeep frame);
  /// Until all that was to be kept is told.
  void wait();

 private:
  struct Changes;
  FrameKeeper(LockedCampaign campaign, const PreparedCampaign& prepared);
  Status look();
  void work();
  void commit(std::vector<FrameToKeep> frames);
  Status name_makers(const std::vector<FrameToKeep>& frames, Changes& changes);
  Status write(const std::vector<FrameToKeep>& frames, Changes& changes);
  Status add_rows(const std::vector<FrameToKeep>& frames, Changes& changes);
  Status put(const FrameToKeep& frame, std::size_t index, Changes& changes);
  Status append(const std::string& lines);
  void take_back(const Changes& changes);
  /// None: the campaign does not have it.
  Result<std::optional<std::int64_t>> number_of(const std::string& frame_id) const;

  LockedCampaign campaign_;
  const PreparedCampaign& prepared_;
  FolderIdentity root_;
  std::int64_t frames_before_ = 0;
  std::int64_t pending_before_ = 0;
  DiskRoom room_needed_;
  std::optional<Provenance> provenance_;
  std::unordered_map<std::uint64_t, std::int64_t> numbers_;  ///< by the beginning of frame ids
  std::int64_t next_ = 0;
  std::uint64_t graph_bytes_ = 0;  ///< of whole lines, each a frame's
  std::mutex mutex_;               ///< guards what follows
  std::condition_variable changed_;
  std::vector<FrameToKeep> frames_;
  bool busy_ = false;
  bool closed_ = false;
  std::jthread thread_;
};

}  // namespace seedframe
