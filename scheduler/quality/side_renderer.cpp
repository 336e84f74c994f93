#include "quality/side_renderer.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "base/files.h"
#include "campaign/finish_queue.h"
#include "campaign/worker_requests.h"
#include "frames/rendered_frame.h"
#include "render/local_executor.h"
#include "render/worker_pool.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// A reference of a large frame takes its time.
constexpr auto kLongest = std::chrono::hours(2);

class SideRun : private RenderClient {
 public:
  SideRun(const RunSetup& setup, fs::path scratch, SideClient& client)
      : scratch_(std::move(scratch)),
        client_(client),
        executor_(worker_options(
            setup.options, scratch_,
            [this](int worker) { return scratch_ / fmt::format("worker-{}.log", worker); })),
        pool_(pool_options(setup.options.pool), executor_, *this),
        judges_(1) {}

  Status run(std::int64_t count) {
    std::vector<PendingFrame> jobs;
    jobs.reserve(static_cast<std::size_t>(count));
    for (std::int64_t job = 0; job < count; ++job) jobs.push_back({job, 0, 0});
    const Result<RunSummary> summary = pool_.run(jobs);
    const std::lock_guard lock(mutex_);
    if (!error_) return error_;
    if (!summary) return forward_error(summary);
    return {};
  }

 private:
  struct Task {
    FrameSpec spec;
    std::string id;
    fs::path rendered;
  };

  static PoolOptions pool_options(PoolOptions options) {
    options.attempts = {.errors = 1, .crashes = 1};
    options.equal_frames = false;
    options.frame_timeout = std::max<std::chrono::milliseconds>(options.frame_timeout, kLongest);
    return options;
  }

  Result<std::optional<RenderRequest>> request(const FrameJob& job) override {
    Result<ExpandedFrame> frame = client_.frame(job.frame);
    if (!frame) return forward_error(frame);
    Task task{frame->spec, frame->id, scratch_ / fmt::format("{}.exr", job.frame)};
    Result<RenderRequest> request = make_render_request(
        *frame, task.rendered,
        [this](const std::string& sha256) { return scratch_ / (sha256 + ".mesh"); });
    if (!request) return forward_error(request);
    request->sample_counts = client_.wants_sample_counts(job.frame);
    request->save_scene = client_.wants_scene(job.frame);
    tasks_[job] = std::move(task);
    return std::move(*request);
  }

  void started(const FrameJob&, int) override {}

  void rendered(const FrameJob& job, const RenderTimings& timings, int) override {
    judges_.push([this, job, timings, task = std::move(tasks_.extract(job).mapped())]() mutable {
      pool_.post_verdict(job, judge(job, timings, std::move(task)));
    });
  }

  Status judge(const FrameJob& job, const RenderTimings& timings, Task task) {
    Result<FramePasses> passes = read_rendered_frame(task.spec, task.id, task.rendered,
                                                     client_.wants_sample_counts(job.frame));
    std::error_code ignored;
    fs::remove(task.rendered, ignored);
    fs::remove(sharp_passes(task.rendered), ignored);
    if (!passes) return forward_error(passes);
    const fs::path scene = client_.wants_scene(job.frame) ? saved_scene(task.rendered) : fs::path();
    const Status judged = client_.rendered(
        job.frame, {std::move(task.spec), std::move(task.id), std::move(*passes), timings, scene});
    if (!scene.empty()) fs::remove(scene, ignored);
    if (!judged) {
      const std::lock_guard lock(mutex_);
      if (error_) error_ = judged;
      pool_.drain();
    }
    return {};
  }

  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override {
    tasks_.erase(job);
    client_.failed(job.frame, failure.message);
  }

  Status check_system() override { return {}; }
  void worker_ready(int, const ReadyMessage&) override {}

  fs::path scratch_;
  SideClient& client_;
  std::map<FrameJob, Task> tasks_;  ///< requested and not yet rendered
  LocalExecutor executor_;
  WorkerPool pool_;
  std::mutex mutex_;
  Status error_;  ///< of the client; guarded by mutex_
  FinishQueue judges_;
};

}  // namespace

Status render_aside(std::int64_t count, const RunSetup& setup, const fs::path& scratch,
                    SideClient& client) {
  if (Status made = make_folders(scratch); !made) return made;
  return SideRun(setup, scratch, client).run(count);
}

}  // namespace seedframe
