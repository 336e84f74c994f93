#include "campaign/run_setup.h"

#include <algorithm>

#include "base/cores.h"
#include "cache/known_worker.h"
#include "campaign/color_config.h"
#include "image/color_trial.h"
#include "image_files/image_writer.h"
#include "plan/worker_plan.h"
#include "render/memory.h"
#include "render/sandbox.h"

namespace seedframe {
namespace {

int cores_for(const RunOptions& options) {
  return options.cores > 0 ? options.cores : core_count();
}

void choose_workers_to_render(RunOptions& options, const CampaignSettings& settings,
                              std::int64_t frames) {
  const RenderSettings& render = settings.render;
  PoolOptions& pool = options.pool;
  int& threads = options.worker.threads;
  // One worker has all devices that are not the CPU, and feeds them with all cores.
  const WorkerPlan plan =
      settings.device == RenderDevice::kCpu
          ? choose_workers(render.width, render.height, render.samples, frames, cores_for(options))
          : WorkerPlan{1, cores_for(options)};
  if (threads == 0) {
    threads = pool.workers > 0 ? std::max(1, cores_for(options) / pool.workers) : plan.threads;
  }
  if (pool.workers == 0) pool.workers = plan.workers;
  constexpr double kShare = 0.8;
  if (pool.worker_memory_bytes == 0) {
    pool.worker_memory_bytes = static_cast<std::int64_t>(
        kShare * static_cast<double>(system_memory_bytes()) / pool.workers);
  }
}

void choose_threads_to_trace(RunOptions& options, std::int64_t frames) {
  int& workers = options.pool.workers;
  int& threads = options.worker.threads;
  const std::int64_t at_once = std::clamp<std::int64_t>(frames, 1, cores_for(options));
  if (workers == 0) workers = static_cast<int>(at_once);
  if (threads == 0) threads = std::max(1, cores_for(options) / workers);
}

Result<RunSetup> set_up_rendering(RunOptions options, const RunPlaces& places,
                                  const CampaignSettings& settings, std::int64_t frames) {
  RunSetup setup;
  // Frames that promise nothing are nobody else's.
  if (settings.determinism.mode != Determinism::Mode::kNone) setup.cache = places.cache;
  WorkerOptions& worker = options.worker;
  const std::unique_ptr<FrameCache> cache =
      FrameCache::open(options.no_cache ? std::filesystem::path() : setup.cache);
  Result<Renderer> renderer = find_renderer(options.blender, &settings, cache.get());
  if (!renderer) return forward_error(renderer);
  if (Status known = check_view(settings, *renderer->color); !known) return forward_error(known);
  if (Status possible = check_encoding(settings.image_encoding); !possible) {
    return forward_error(possible);
  }
  if (!renderer->blender.tested) {
    setup.notes.push_back(
        fmt::format("Blender {} is not a version that Seedframe is tested with ({}); going on",
                    renderer->blender.version, tested_blender_versions()));
  }
  worker.blender = renderer->blender.program;
  worker.scripts = places.scripts;
  worker.preload = places.preload;
  if (std::error_code error; !std::filesystem::exists(worker.preload, error)) {
    return fail(ErrorKind::kEnvironment,
                "{} is missing: it belongs beside the program, which was built with it",
                worker.preload.string());
  }
  worker.conditions.persistent_data = settings.persistent_data;
  worker.conditions.device = settings.device;
  worker.conditions.denoise = settings.render.denoise != Denoise::kOff;
  if (settings.determinism.mode == Determinism::Mode::kPortable) {
    worker.conditions.kernels = kernels_of(settings.determinism.isa);
  }
  options.input_folders = settings.input_folders;
  choose_workers_to_render(options, settings, frames);
  if (options.sandbox) {
    if (Status works = check_sandbox(); !works) return forward_error(works);
  }
  setup.options = std::move(options);
  setup.blender = std::move(renderer->blender);
  setup.color = std::move(renderer->color);
  return setup;
}

}  // namespace

Status check_view(const CampaignSettings& settings, const ColorManagement& color) {
  const Status known = color.check(settings.image);
  if (known) return {};
  return fail(ErrorKind::kInput, "{}: {}",
              settings.image_place.file.empty() ? "image" : settings.image_place.text(),
              known.error().message);
}

namespace {

/// The config that is to be used, tried if it may be a stranger's.
Result<std::filesystem::path> color_config(const CampaignSettings* settings,
                                           const BlenderInfo& blender) {
  if (settings == nullptr || !settings->ocio_config) return find_ocio_config(blender);
  std::error_code error;
  const std::filesystem::path file = std::filesystem::canonical(*settings->ocio_config, error);
  if (!error && !file.string().starts_with("/usr/share/")) {
    if (Status usable = try_color_config(file, settings->image); !usable) {
      return forward_error(usable);
    }
  }
  return *settings->ocio_config;
}

}  // namespace

Result<Renderer> find_renderer(const std::string& program, const CampaignSettings* settings,
                               FrameCache* cache) {
  Result<BlenderInfo> blender = known_blender(cache, program);
  if (!blender) return forward_error(blender);
  const Result<std::filesystem::path> path = color_config(settings, *blender);
  if (!path) return forward_error(path);
  Result<ColorManagement> color = ColorManagement::load(*path);
  if (!color) return forward_error(color);
  return Renderer{std::move(*blender), std::make_shared<const ColorManagement>(std::move(*color))};
}

Result<RunSetup> set_up_run(RunOptions options, const RunPlaces& places,
                            const CampaignSettings& settings, std::int64_t frames) {
  if (settings.labels == LabelSource::kIndexPass) {
    return set_up_rendering(std::move(options), places, settings, frames);
  }
  choose_threads_to_trace(options, frames);
  RunSetup setup;
  setup.options = std::move(options);
  return setup;
}

std::string describe(const RunSetup& setup) {
  const int workers = setup.options.pool.workers;
  const int threads = setup.options.worker.threads;
  if (setup.make) return "tasks of Slurm, which choose their workers";
  if (!setup.color) {
    return fmt::format("{} frames at once, threads each: {}, without Blender", workers, threads);
  }
  return fmt::format("{} × Blender {}, threads each: {}", workers, setup.blender.version, threads);
}

}  // namespace seedframe
