// How many workers, and how many threads each.
#pragma once

#include <cstdint>

namespace seedframe {

struct WorkerPlan {
  int workers = 1;
  int threads = 1;  ///< of each worker
};

/// The fastest split of `cores` for a campaign of `frames` equal frames of width × height pixels at
/// `samples` samples each. Pure; it changes the time a campaign takes and never its pixels. The
/// thresholds and the measurements behind them are in worker_plan.cpp.
WorkerPlan choose_workers(int width, int height, int samples, std::int64_t frames, int cores);

}  // namespace seedframe
