#include "cli/run_options.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>

#include "campaign/label_run.h"
#include "campaign/render_run.h"
#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/progress.h"
#include "render/worker_plan.h"

namespace seedframe {
namespace {

std::atomic<CampaignRun*> g_run = nullptr;
volatile std::sig_atomic_t g_interrupted = 0;

extern "C" void drain_on_signal(int) {
  g_interrupted = 1;
  if (CampaignRun* run = g_run.load()) run->drain();
}

/// SIGINT and SIGTERM drain the run while this lives.
class DrainOnSignals {
 public:
  explicit DrainOnSignals(CampaignRun& run) {
    g_interrupted = 0;
    g_run = &run;
    struct sigaction action = {};
    action.sa_handler = drain_on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, &interrupt_);
    sigaction(SIGTERM, &action, &terminate_);
  }
  ~DrainOnSignals() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
    g_run = nullptr;
  }
  DrainOnSignals(const DrainOnSignals&) = delete;
  DrainOnSignals& operator=(const DrainOnSignals&) = delete;
  static bool interrupted() { return g_interrupted != 0; }

 private:
  struct sigaction interrupt_ = {};
  struct sigaction terminate_ = {};
};

int print_outcome(Campaign& campaign, const RunSummary& summary, double seconds) {
  const std::string folder = campaign.files.root().string();
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return report(counts.error());
  fmt::print("{} of {} frames are done ({} in this run, {})\n", counts->done, counts->total(),
             summary.committed, duration_text(seconds));
  if (counts->failed > 0) {
    fmt::print(
        "{} frames failed: 'seedframe status {}' names them, 'seedframe resume {}' tries "
        "them again\n",
        counts->failed, folder, folder);
    return kExitSomeFailed;
  }
  if (counts->done < counts->total()) {
    fmt::print("'seedframe resume {}' renders the rest\n", folder);
    return DrainOnSignals::interrupted() ? kExitInterrupted : kExitOk;
  }
  const Result<std::string> hash = campaign.store.dataset_hash();
  if (!hash) return report(hash.error());
  fmt::print("dataset hash {}\n'seedframe export {} --format coco' writes annotations\n", *hash,
             folder);
  return kExitOk;
}

}  // namespace

void add_run_options(CLI::App& verb, RunArguments& arguments) {
  verb.add_option("--blender", arguments.blender,
                  "Blender to render with: a path, or a name in PATH")
      ->capture_default_str();
  verb.add_option("--workers", arguments.workers, "Blender processes (default: chosen)")
      ->check(CLI::Range(1, 256));
  verb.add_option("--threads", arguments.threads, "threads of each (default: chosen)")
      ->check(CLI::Range(1, 1024));
  verb.add_option("--max-attempts", arguments.max_attempts, "attempts before a frame has failed")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  verb.add_option("--frame-timeout", arguments.frame_timeout_s,
                  "seconds after which a worker counts as hung")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  verb.add_flag("--quiet", arguments.quiet, "no progress");
}

namespace {

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
  options.workers = arguments.workers > 0 ? arguments.workers : plan.workers;
  options.threads = arguments.threads > 0   ? arguments.threads
                    : arguments.workers > 0 ? std::max(1, cores() / arguments.workers)
                                            : plan.threads;
  options.max_attempts = arguments.max_attempts;
  options.frame_timeout =
      std::chrono::milliseconds(static_cast<long long>(arguments.frame_timeout_s * 1e3));
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

namespace {

/// "rendering 24 frames of 320 × 240 at 32 samples"
std::string describe_work(const CampaignConfig& config, std::size_t frames) {
  const RenderConfig& render = config.render;
  if (config.labels.source == LabelSource::kTwin) {
    return fmt::format("tracing the labels of {} frames of {} × {}", frames, render.width,
                       render.height);
  }
  return fmt::format("rendering {} frames of {} × {} at {} samples", frames, render.width,
                     render.height, render.samples);
}

std::unique_ptr<CampaignRun> new_run(Campaign& campaign, PreparedCampaign& prepared,
                                     const RunSetup& setup, Provenance& provenance,
                                     RunObserver& observer) {
  if (!setup.color) {
    return std::make_unique<LabelRun>(campaign, prepared, setup.options, observer);
  }
  return std::make_unique<RenderRun>(campaign, prepared, *setup.color, provenance, setup.options,
                                     observer);
}

}  // namespace

int run_campaign(Campaign& campaign, PreparedCampaign& prepared, const RunSetup& setup,
                 const std::vector<PendingFrame>& frames, const RunArguments& arguments) {
  Result<Provenance> provenance = Provenance::load(
      campaign.files, prepared, setup.color ? setup.color->config_hash() : std::string());
  if (!provenance) return report(provenance.error());
  if (Status written = provenance->write(); !written) return report(written.error());
  const Result<FrameCounts> before = campaign.store.counts();
  if (!before) return report(before.error());
  if (!arguments.quiet && !frames.empty()) {
    std::fprintf(stderr, "%s into %s: %s\n", describe_work(prepared.config, frames.size()).c_str(),
                 campaign.files.root().c_str(), describe(setup).c_str());
  }
  const auto start = std::chrono::steady_clock::now();
  Progress progress(static_cast<std::int64_t>(frames.size()), before->done,
                    arguments.quiet || frames.empty());
  const auto run = new_run(campaign, prepared, setup, *provenance, progress);
  Result<RunSummary> summary = [&] {
    const DrainOnSignals drain(*run);
    return run->run(frames);
  }();
  progress.finish();
  if (!summary) {
    const int code = report(summary.error());
    std::fprintf(stderr, "seedframe: nothing is lost: 'seedframe resume %s' goes on\n",
                 campaign.files.root().c_str());
    return code;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return print_outcome(campaign, *summary, seconds.count());
}

}  // namespace seedframe
