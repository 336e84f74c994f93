#include "tests/stability/case_renderer.h"

#include <cstdio>

#include <fmt/format.h>

#include "image/pass_reader.h"
#include "render/blender_info.h"
#include "render/local_executor.h"
#include "render/worker_pool.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

class Client : public RenderClient {
 public:
  Client(const std::vector<StabilityCase>& cases, const RenderFolders& folders,
         CaseRendering& rendering)
      : folders_(folders), rendering_(rendering) {
    for (const StabilityCase& each : cases) {
      rendering.frames.emplace_back(each.frames.size());
      for (std::size_t i = 0; i < each.frames.size(); ++i) {
        frames_.push_back({&each, i, rendering.frames.size() - 1});
      }
    }
  }

  Result<RunSummary> run(const WorkerOptions& worker) {
    PoolOptions options;
    options.attempts = {1, 1};
    options.equal_frames = false;
    LocalExecutor executor(worker);
    WorkerPool pool(options, executor, *this);
    pool_ = &pool;
    std::vector<PendingFrame> pending;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      pending.push_back({static_cast<std::int64_t>(i), 0, 0});
    }
    return pool.run(pending);
  }

 private:
  struct Frame {
    const StabilityCase* of = nullptr;
    std::size_t index = 0;    ///< in its case
    std::size_t case_at = 0;  ///< the case's index
  };

  RenderedFrame& rendered_frame(const FrameJob& job) {
    const Frame& frame = frames_[static_cast<std::size_t>(job.frame)];
    return rendering_.frames[frame.case_at][frame.index];
  }

  Result<std::optional<RenderRequest>> request(const FrameJob& job) override {
    const Frame& frame = frames_[static_cast<std::size_t>(job.frame)];
    Json spec = to_json(frame.of->frames[frame.index]);
    spec["stability_origin_m"] = frame.of->blender_origin_m;
    RenderRequest request;
    request.spec = canonical_json(spec);
    request.output = folders_.scratch / fmt::format("{}.exr", job.frame);
    request.meshes = folders_.meshes;
    return request;
  }
  void started(const FrameJob&, int) override {}
  void rendered(const FrameJob& job, const RenderTimings&, int) override {
    rendered_frame(job).passes = folders_.scratch / fmt::format("{}.exr", job.frame);
    pool_->post_verdict(job, {});
    if (job.frame % 20 == 0) {
      fmt::print(stderr, "Blender {}: {} of {} frames\n", rendering_.blender, job.frame,
                 frames_.size());
    }
  }
  Status check_system() override { return {}; }
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override {
    rendered_frame(job).failure = failure.message;
  }
  void worker_ready(int, const ReadyMessage&) override {}

  const RenderFolders& folders_;
  CaseRendering& rendering_;
  std::vector<Frame> frames_;  ///< by job
  WorkerPool* pool_ = nullptr;
};

}  // namespace

Result<CaseRendering> render_cases(const std::vector<StabilityCase>& cases,
                                   const std::string& blender, const RenderFolders& folders) {
  const auto found = probe_blender(blender);
  if (!found) return forward_error(found);
  CaseRendering rendering;
  rendering.blender = found->version;
  WorkerOptions worker;
  worker.blender = found->program;
  worker.scripts = folders.scripts;
  worker.log_path = [&](int) { return folders.scratch / "worker.log"; };
  worker.threads = 2;
  const auto summary = Client(cases, folders, rendering).run(worker);
  if (!summary) return forward_error(summary);
  return rendering;
}

Result<FrameImages> read_rendered(const RenderedFrame& frame, const FrameSpec& spec) {
  constexpr int kMostIds = 32767;
  auto passes =
      read_passes(frame.passes, {spec.render.width, spec.render.height, true, true, kMostIds});
  if (!passes) return forward_error(passes);
  return FrameImages{std::move(passes->instance_ids), std::move(*passes->depth),
                     std::move(*passes->normal)};
}

}  // namespace seedframe
