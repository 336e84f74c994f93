#include "console/run_options.h"

#include <cstdio>

#include <CLI/CLI.hpp>

#include "campaign/run_setup.h"
#include "console/arguments.h"
#include "console/blender_option.h"
#include "console/home.h"
#include "console/say.h"

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
  add_blender_option(verb, options.blender);
  verb.add_option("--workers", pool.workers, "Blender processes (default: chosen)")
      ->check(CLI::Range(1, 256));
  verb.add_option("--threads", options.worker.threads, "threads of each (default: chosen)")
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
      ->check(NotNegative())
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
      ->check(NotNegative())
      ->capture_default_str();
  verb.add_flag("--no-space-check", options.no_space_check,
                "start though the frames will probably not fit on the disk");
  verb.add_flag("--quiet", options.quiet, "no progress");
}

Result<RunSetup> set_up_run(const RunOptions& options, const CampaignSettings& settings,
                            std::int64_t frames) {
  const RunPlaces places{seedframe_home() / "blender_scripts", worker_preload(), cache_folder()};
  return set_up_run(options, places, settings, frames);
}

void print_notes(const RunSetup& setup) {
  for (const std::string& note : setup.notes) {
    say_aside("seedframe: note: {}\n", note);
  }
}

}  // namespace seedframe
