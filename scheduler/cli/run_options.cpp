#include "cli/run_options.h"

#include <algorithm>
#include <cstdio>
#include <thread>

#include <CLI/CLI.hpp>

#include "campaign/render_run.h"
#include "cli/home.h"
#include "plan/worker_plan.h"
#include "render/memory.h"
#include "render/sandbox.h"

namespace seedframe {
void add_run_options(CLI::App& verb, RunArguments& arguments) {
  verb.add_option("--blender", arguments.blender,
                  "Blender to render with: a path, or a name in PATH")
      ->capture_default_str();
  verb.add_option("--workers", arguments.workers, "Blender processes (default: chosen)")
      ->check(CLI::Range(1, 256));
  verb.add_option("--threads", arguments.threads, "threads of each (default: chosen)")
      ->check(CLI::Range(1, 1024));
  verb.add_option("--max-attempts", arguments.max_attempts, "errors before a frame has failed")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  verb.add_option("--max-crashes", arguments.max_crashes,
                  "workers that a frame may cost before it is quarantined")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  verb.add_option("--frame-timeout", arguments.frame_timeout_s,
                  "most seconds that a worker may take over a frame; once some are done, ten times "
                  "the longest of them counts")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  verb.add_option("--heartbeat-timeout", arguments.heartbeat_timeout_s,
                  "seconds without a sign of life after which a worker counts as hung")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  verb.add_option("--frames-per-worker", arguments.frames_per_worker,
                  "frames after which a worker is replaced; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb.add_option(
          "--worker-memory", arguments.worker_memory_gb,
          "GB above which a worker is replaced after its frame (default: four fifths of the "
          "memory, shared)")
      ->check(CLI::PositiveNumber);
  verb.add_flag("--sandbox", arguments.sandbox,
                "workers without network, that can write nowhere but into the campaign (needs "
                "bubblewrap)");
  verb.add_flag("--no-cache", arguments.no_cache,
                "render frames that have been rendered on this machine, too");
  verb.add_option("--pause-limit", arguments.pause_limit_s,
                  "seconds to wait for room when the disk is full; 0: end at once")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb.add_flag("--no-space-check", arguments.no_space_check,
                "start though the frames will probably not fit on the disk");
  verb.add_flag("--quiet", arguments.quiet, "no progress");
}

namespace {

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<long long>(seconds * 1e3));
}

int cores() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

Result<RunSetup> set_up_rendering(const RunArguments& arguments, const CampaignConfig& config,
                                  std::int64_t frames) {
  Result<BlenderInfo> blender = probe_blender(arguments.blender);
  if (!blender) return forward_error(blender);
  if (!blender->tested) {
    std::fprintf(stderr,
                 "seedframe: note: Blender %s is not a version that Seedframe is tested with "
                 "(3.4); going on\n",
                 blender->version.c_str());
  }
  Result<ColorManagement> color = load_color_management(config, *blender);
  if (!color) return forward_error(color);
  const WorkerPlan plan = choose_workers(config.render.width, config.render.height,
                                         config.render.samples, frames, cores());
  RunOptions options;
  options.blender = *blender;
  options.scripts = seedframe_home() / "blender_scripts";
  options.preload = worker_preload();
  if (std::error_code error; !std::filesystem::exists(options.preload, error)) {
    return fail(ErrorKind::kEnvironment,
                "{} is missing: it belongs beside the program, which was built with it",
                options.preload.string());
  }
  options.conditions.persistent_data = config.render.persistent_data;
  if (config.determinism.mode == DeterminismConfig::Mode::kPortable) {
    options.conditions.kernels = kernels_of(config.determinism.isa);
  }
  options.workers = arguments.workers > 0 ? arguments.workers : plan.workers;
  options.threads = arguments.threads > 0   ? arguments.threads
                    : arguments.workers > 0 ? std::max(1, cores() / arguments.workers)
                                            : plan.threads;
  if (arguments.sandbox) {
    if (Status works = check_sandbox(); !works) return forward_error(works);
  }
  options.sandbox = arguments.sandbox;
  // Frames that promise nothing are nobody else's.
  if (config.determinism.mode != DeterminismConfig::Mode::kNone) options.cache = cache_folder();
  options.take_from_cache = !arguments.no_cache;
  options.attempts = {arguments.max_attempts, arguments.max_crashes};
  options.frame_timeout = milliseconds(arguments.frame_timeout_s);
  options.heartbeat_timeout = milliseconds(arguments.heartbeat_timeout_s);
  options.frames_per_worker = arguments.frames_per_worker;
  constexpr double kShare = 0.8;
  options.worker_memory_bytes = static_cast<std::int64_t>(
      arguments.worker_memory_gb > 0.0
          ? arguments.worker_memory_gb * 1e9
          : kShare * static_cast<double>(system_memory_bytes()) / options.workers);
  return RunSetup{std::move(options), std::move(*color)};
}

}  // namespace

Result<RunSetup> set_up_run(const RunArguments& arguments, const CampaignConfig& config,
                            std::int64_t frames) {
  if (config.labels.source == LabelSource::kIndexPass) {
    return set_up_rendering(arguments, config, frames);
  }
  RunSetup setup;
  const std::int64_t frames_at_once = std::clamp<std::int64_t>(frames, 1, cores());
  setup.options.workers =
      arguments.workers > 0 ? arguments.workers : static_cast<int>(frames_at_once);
  setup.options.threads =
      arguments.threads > 0 ? arguments.threads : std::max(1, cores() / setup.options.workers);
  return setup;
}

std::string describe(const RunSetup& setup) {
  const RunOptions& options = setup.options;
  if (!setup.color) {
    return fmt::format("{} frames at once, threads each: {}, without Blender", options.workers,
                       options.threads);
  }
  return fmt::format("{} × Blender {}, threads each: {}", options.workers, options.blender.version,
                     options.threads);
}

}  // namespace seedframe
