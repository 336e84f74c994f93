#include "cli/run_options.h"

#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "base/cores.h"
#include "campaign/render_run.h"
#include "cli/home.h"
#include "plan/worker_plan.h"
#include "render/memory.h"
#include "render/sandbox.h"

namespace seedframe {
namespace {

using std::chrono::milliseconds;

CLI::Option* add_seconds(CLI::App& verb, const std::string& name, milliseconds& time,
                         const std::string& help) {
  const auto set = [&time](double seconds) {
    time = milliseconds(static_cast<std::int64_t>(seconds * 1e3));
  };
  return verb.add_option_function<double>(name, set, help)
      ->check(CLI::Range(0.1, 1e6))
      ->default_str(fmt::format("{}", static_cast<double>(time.count()) / 1e3));
}

}  // namespace

void add_run_options(CLI::App& verb, RunOptions& options) {
  PoolOptions& pool = options.pool;
  verb.add_option("--blender", pool.worker.blender,
                  "Blender to render with: a path, or a name in PATH")
      ->default_str(pool.worker.blender.string());
  verb.add_option("--workers", pool.workers, "Blender processes (default: chosen)")
      ->check(CLI::Range(1, 256));
  verb.add_option("--threads", pool.worker.threads, "threads of each (default: chosen)")
      ->check(CLI::Range(1, 1024));
  verb.add_option("--max-attempts", pool.attempts.errors, "errors before a frame has failed")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  verb.add_option("--max-crashes", pool.attempts.crashes,
                  "workers that a frame may cost before it is quarantined")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  add_seconds(verb, "--frame-timeout", pool.frame_timeout,
              "most seconds that a worker may take over a frame; once some are done, ten times "
              "the longest of them counts");
  add_seconds(verb, "--heartbeat-timeout", pool.heartbeat_timeout,
              "seconds without a sign of life after which a worker counts as hung");
  verb.add_option("--frames-per-worker", pool.frames_per_worker,
                  "frames after which a worker is replaced; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  const auto set_memory = [&pool](double gigabytes) {
    pool.worker_memory_bytes = static_cast<std::int64_t>(gigabytes * 1e9);
  };
  verb.add_option_function<double>(
          "--worker-memory", set_memory,
          "GB above which a worker is replaced after its frame (default: four fifths of the "
          "memory, shared)")
      ->check(CLI::PositiveNumber);
  verb.add_flag("--sandbox", options.sandbox,
                "workers without network, that can write nowhere but into the campaign (needs "
                "bubblewrap)");
  verb.add_flag("--no-cache", options.no_cache,
                "render frames that have been rendered on this machine, too");
  verb.add_option("--pause-limit", options.pause_limit_s,
                  "seconds to wait for room when the disk is full; 0: end at once")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb.add_flag("--no-space-check", options.no_space_check,
                "start though the frames will probably not fit on the disk");
  verb.add_flag("--quiet", options.quiet, "no progress");
}

namespace {

void make_choices(PoolOptions& pool, const RenderSettings& render, std::int64_t frames) {
  const WorkerPlan plan =
      choose_workers(render.width, render.height, render.samples, frames, core_count());
  if (pool.worker.threads == 0) {
    pool.worker.threads =
        pool.workers > 0 ? std::max(1, core_count() / pool.workers) : plan.threads;
  }
  if (pool.workers == 0) pool.workers = plan.workers;
  constexpr double kShare = 0.8;
  if (pool.worker_memory_bytes == 0) {
    pool.worker_memory_bytes = static_cast<std::int64_t>(
        kShare * static_cast<double>(system_memory_bytes()) / pool.workers);
  }
}

Result<RunSetup> set_up_rendering(RunOptions options, const CampaignSettings& settings,
                                  std::int64_t frames) {
  RunSetup setup;
  WorkerOptions& worker = options.pool.worker;
  Result<BlenderInfo> blender = probe_blender(worker.blender.string());
  if (!blender) return forward_error(blender);
  if (!blender->tested) {
    std::fprintf(stderr,
                 "seedframe: note: Blender %s is not a version that Seedframe is tested with "
                 "(3.4); going on\n",
                 blender->version.c_str());
  }
  Result<ColorManagement> color = load_color_management(settings, *blender);
  if (!color) return forward_error(color);
  worker.blender = blender->program;
  worker.scripts = seedframe_home() / "blender_scripts";
  worker.preload = worker_preload();
  if (std::error_code error; !std::filesystem::exists(worker.preload, error)) {
    return fail(ErrorKind::kEnvironment,
                "{} is missing: it belongs beside the program, which was built with it",
                worker.preload.string());
  }
  worker.conditions.persistent_data = settings.persistent_data;
  if (settings.determinism.mode == Determinism::Mode::kPortable) {
    worker.conditions.kernels = kernels_of(settings.determinism.isa);
  }
  make_choices(options.pool, settings.render, frames);
  if (options.sandbox) {
    if (Status works = check_sandbox(); !works) return forward_error(works);
  }
  // Frames that promise nothing are nobody else's.
  if (settings.determinism.mode != Determinism::Mode::kNone) setup.cache = cache_folder();
  setup.options = std::move(options);
  setup.blender = std::move(*blender);
  setup.color = std::make_shared<const ColorManagement>(std::move(*color));
  return setup;
}

}  // namespace

Result<RunSetup> set_up_run(RunOptions options, const CampaignSettings& settings,
                            std::int64_t frames) {
  if (settings.labels == LabelSource::kIndexPass) {
    return set_up_rendering(std::move(options), settings, frames);
  }
  PoolOptions& pool = options.pool;
  const std::int64_t frames_at_once = std::clamp<std::int64_t>(frames, 1, core_count());
  if (pool.workers == 0) pool.workers = static_cast<int>(frames_at_once);
  if (pool.worker.threads == 0) pool.worker.threads = std::max(1, core_count() / pool.workers);
  RunSetup setup;
  setup.options = std::move(options);
  return setup;
}

std::string describe(const RunSetup& setup) {
  const PoolOptions& pool = setup.options.pool;
  if (!setup.color) {
    return fmt::format("{} frames at once, threads each: {}, without Blender", pool.workers,
                       pool.worker.threads);
  }
  return fmt::format("{} × Blender {}, threads each: {}", pool.workers, setup.blender.version,
                     pool.worker.threads);
}

}  // namespace seedframe
