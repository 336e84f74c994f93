// A run that waits when the disk or the memory is exhausted, and goes on when that has passed.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "base/error.h"
#include "render/frame_job.h"
#include "render/worker_pool.h"

namespace seedframe {

/// What run_with_pauses does and asks. No disk, process or clock is anywhere else in it.
class PausableRun {
 public:
  virtual ~PausableRun() = default;

  virtual Result<RunSummary> run(const std::vector<PendingFrame>& frames) = 0;
  /// By all runs so far.
  virtual std::int64_t frames_done() const = 0;
  /// Nobody waits any longer.
  virtual bool is_drained() const = 0;

  virtual bool has_room() = 0;
  /// Trusts nothing that is in memory; those of `wanted` that are missing.
  virtual Result<std::vector<PendingFrame>> reopen(const std::vector<PendingFrame>& wanted) = 0;
  virtual void tell_pause(const Error& why) = 0;
  virtual void tell_end_of_pause(std::size_t frames) = 0;

  virtual std::chrono::steady_clock::time_point now() const = 0;
  virtual void sleep(std::chrono::milliseconds time) = 0;
};

/// After a kExhausted error looks twice a second whether there is room again, and runs what is
/// missing. The error is returned when that takes longer than `limit`, when the run is drained, or
/// when nothing was done after three pauses in a row: then waiting does not help.
Result<RunSummary> run_with_pauses(PausableRun& run, std::vector<PendingFrame> frames,
                                   std::chrono::duration<double> limit);

}  // namespace seedframe
