// Where each frame of a run is: to be given out, with a task, come back, or over.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "render/frame_job.h"
#include "render/schedule.h"
#include "render/worker_pool.h"

namespace seedframe {

struct BatchId {
  int submission = 0;
  int batch = 0;
  auto operator<=>(const BatchId&) const = default;
};

/// Every frame is in one of these states:
///
///     free --give_out--> out --take--> settling --settle--> over
///      ^                  |               |
///      |---- lose --------|---- settle ---|
///
/// Thread-safe.
class FrameLedger {
 public:
  explicit FrameLedger(const AttemptLimits& limits) : limits_(limits) {}

  void add(const PendingFrame& frame, std::string frame_id);

  /// Of a frame that is free.
  void give_out(std::int64_t frame, const BatchId& batch);
  /// Of frames that are free: those that were lost equally often, by that; in order.
  std::map<int, std::vector<std::int64_t>> free_frames() const;
  /// Attempts that workers of earlier tasks have died of.
  int crashes(std::int64_t frame) const;

  struct Taken {
    std::string frame_id;
    int first_attempt = 1;  ///< the number of the record's first
  };
  /// Somebody has a record of the frame, with so many attempts; none: it is not wanted, because
  /// there was one already, or never. Whoever is told a number settles the frame.
  std::optional<Taken> take(std::int64_t frame, int attempts);

  /// Its task could not say what became of it, `alone`: it had no other frame. What becomes of it:
  /// free again, or, when it has cost as many tasks of its own as a frame may cost workers,
  /// settling, and the caller must settle it.
  struct Lost {
    Consequence consequence = Consequence::kRetry;
    int attempt = 1;
  };
  Lost lose(std::int64_t frame, bool alone);
  /// Its task was told to stop, or could not begin: nobody's fault.
  void give_back(std::int64_t frame);
  /// What came was refused; whether it may be tried again.
  Consequence refuse(std::int64_t frame);

  void settle_done(std::int64_t frame);
  void settle_failed(std::int64_t frame, Consequence consequence);

  /// Frames of the batch that are with it still.
  std::vector<std::int64_t> out_with(const BatchId& batch,
                                     const std::vector<std::int64_t>& frames) const;
  bool all_over() const;
  bool any_settling() const;
  std::int64_t out() const;
  RunSummary summary() const;

 private:
  enum class Place { kFree, kOut, kSettling, kOver };
  struct Entry {
    std::string frame_id;
    int attempts = 0;
    int crashes = 0;
    int errors = 0;  ///< results that were refused
    int losses = 0;
    int lost_alone = 0;
    Place place = Place::kFree;
    BatchId batch;
  };
  void move(Entry& entry, Place place);

  AttemptLimits limits_;
  mutable std::mutex mutex_;
  std::map<std::int64_t, Entry> frames_;
  std::map<Place, std::int64_t> counts_;
  RunSummary summary_;
};

}  // namespace seedframe
