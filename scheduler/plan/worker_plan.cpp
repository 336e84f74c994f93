#include "plan/worker_plan.h"

#include <algorithm>

// One frame costs a worker a part that only one thread does (scene, BVH, EXR: f) and a part that
// all its threads share (path tracing: c core-seconds). With t threads it takes f + c / t, so the t
// cores are used with an efficiency of (f + c) / (t f + c). More workers of one thread are always
// the most efficient; but each holds its own copy of the meshes and starts for two seconds, and the
// last frames of a campaign leave cores idle. So a worker gets as many threads as cost no more than
// kLoss of its cores.
//
// Measured with Blender 3.4 on 2 cores, 12 instances, 10 materials, milliseconds per frame:
//
//     size, samples           2 workers x 1 thread   1 worker x 2 threads   camera rays
//     128 x 128, 1                      71                    100             0.016 M
//     128 x 128, 16                    596                    577             0.26 M
//     320 x 240, 32                   5464                   5540             2.5 M
//
// (The machine was busy with other work: the columns compare, the absolute times are 2 to 4 times
// those of an idle one, where a 128 x 128 frame at 1 sample takes 21 to 34 ms of one thread, at 16
// samples 320 ms.) That makes f about 15 ms and c about 1.2 µs per camera ray.

namespace seedframe {
namespace {

constexpr double kSingleThreadedSeconds = 0.015;
constexpr double kSecondsPerCameraRay = 1.2e-6;
constexpr double kLoss = 0.05;

}  // namespace

WorkerPlan choose_workers(int width, int height, int samples, std::int64_t frames, int cores) {
  cores = std::max(1, cores);
  const double rays = static_cast<double>(width) * height * std::max(1, samples);
  const double shared_over_single = kSecondsPerCameraRay * rays / kSingleThreadedSeconds;
  const double threads = 1.0 + kLoss * (1.0 + shared_over_single);
  const int wanted_threads = static_cast<int>(std::min<double>(threads, cores));
  const std::int64_t most_workers = std::clamp<std::int64_t>(frames, 1, cores);
  WorkerPlan plan;
  plan.workers = static_cast<int>(std::min<std::int64_t>(cores / wanted_threads, most_workers));
  plan.threads = cores / plan.workers;
  return plan;
}

}  // namespace seedframe
