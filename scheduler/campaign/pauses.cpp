#include "campaign/pauses.h"

namespace seedframe {
namespace {

constexpr auto kLook = std::chrono::milliseconds(500);
constexpr int kMostFruitless = 3;

using Deadline = std::chrono::steady_clock::time_point;

bool wait_for_room(PausableRun& run, Deadline deadline) {
  while (run.now() < deadline && !run.is_drained()) {
    run.sleep(kLook);
    if (run.has_room()) return !run.is_drained();
  }
  return false;
}

/// From the error that made the pause to the frames that are still to be done, or an error when it
/// is not to be waited for any longer.
Result<std::vector<PendingFrame>> pause(PausableRun& run, const std::vector<PendingFrame>& frames,
                                        const Error& why, std::chrono::duration<double> limit) {
  run.tell_pause(why);
  const Deadline deadline =
      run.now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(limit);
  Result<std::vector<PendingFrame>> left = tl::unexpected(why);
  while (wait_for_room(run, deadline)) {
    left = run.reopen(frames);
    if (left || left.error().kind != ErrorKind::kExhausted) break;
  }
  if (left) run.tell_end_of_pause(left->size());
  return left;
}

}  // namespace

Result<RunSummary> run_with_pauses(PausableRun& run, std::vector<PendingFrame> frames,
                                   std::chrono::duration<double> limit) {
  Result<RunSummary> summary = run.run(frames);
  int fruitless = 0;  // pauses in a row after which nothing was done
  while (!summary && summary.error().kind == ErrorKind::kExhausted && limit.count() > 0.0 &&
         fruitless < kMostFruitless) {
    const std::int64_t done = run.frames_done();
    Result<std::vector<PendingFrame>> left = pause(run, frames, summary.error(), limit);
    if (!left) return forward_error(left);
    frames = std::move(*left);
    summary = run.run(frames);
    fruitless = run.frames_done() > done ? 0 : fruitless + 1;
  }
  return summary;
}

}  // namespace seedframe
