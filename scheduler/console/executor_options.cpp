#include "console/executor_options.h"

#include <CLI/CLI.hpp>

#include "console/arguments.h"
#include "slurm/slurm_factory.h"

namespace seedframe {
namespace {

/// Key in the store's meta: SlurmOptions as JSON; empty: this machine.
constexpr const char* kExecutorKey = "executor";

constexpr const char* kGroup = "Slurm";

/// An option that changes one member.
template <class T, class Set>
CLI::Option* add_change(CLI::App& verb, ExecutorOptions& options, const std::string& name, Set set,
                        const std::string& help) {
  return verb
      .add_option_function<T>(
          name,
          [&options, set](const T& value) {
            options.changes.push_back([set, value](SlurmOptions& slurm) { set(slurm, value); });
          },
          help)
      ->group(kGroup);
}

std::string check_time(const std::string& text) {
  const Result<std::int64_t> seconds = read_slurm_time(text);
  return seconds ? std::string() : seconds.error().message;
}

}  // namespace

void add_executor_options(CLI::App& verb, ExecutorOptions& options) {
  verb.add_option("--executor", options.name,
                  "local: workers of this machine; slurm: tasks of a cluster (docs/cluster.md)")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->group(kGroup);
  add_change<std::string>(
      verb, options, "--partition",
      [](SlurmOptions& slurm, const std::string& name) { slurm.partition = name; },
      "partition that tasks are submitted to");
  add_change<int>(
      verb, options, "--nodes", [](SlurmOptions& slurm, int nodes) { slurm.nodes = nodes; },
      "most tasks at once, each on a node")
      ->check(CLI::Range(1, 100'000));
  add_change<std::string>(
      verb, options, "--time",
      [](SlurmOptions& slurm, const std::string& time) { slurm.time_s = *read_slurm_time(time); },
      "most time of a task, as sbatch takes it, such as 90 or 1:30:00")
      ->check(CLI::Validator(check_time, "TIME"));
  add_change<int>(
      verb, options, "--cpus-per-task", [](SlurmOptions& slurm, int cpus) { slurm.cpus = cpus; },
      "CPUs of a task (default: those of the partition's smallest node)")
      ->check(CLI::Range(1, 4096));
  add_change<int>(
      verb, options, "--batch-frames",
      [](SlurmOptions& slurm, int frames) { slurm.batch_frames = frames; },
      "frames of a task (default: chosen by measured times)")
      ->check(CLI::Range(1, 1'000'000));
  add_change<double>(
      verb, options, "--poll", [](SlurmOptions& slurm, double poll_s) { slurm.poll_s = poll_s; },
      "seconds between looks at the queue (default: 5)")
      ->check(CLI::Range(0.1, 3600.0));
  add_change<std::string>(
      verb, options, "--node-folder",
      [](SlurmOptions& slurm, const std::string& folder) { slurm.node_folder = folder; },
      "folder on each node for what tasks work with (default: in its TMPDIR or /tmp)");
  add_change<std::vector<std::string>>(
      verb, options, "--slurm-option",
      [](SlurmOptions& slurm, const std::vector<std::string>& more) { slurm.more = more; },
      "an option for sbatch, such as --slurm-option=--account=lab")
      ->allow_extra_args(false);
}

Result<std::optional<SlurmOptions>> choose_executor(const ExecutorOptions& said,
                                                    const JobStore* store) {
  std::optional<SlurmOptions> slurm;
  if (store != nullptr) {
    const Result<std::string> text = store->meta(kExecutorKey);
    if (!text) return forward_error(text);
    if (!text->empty()) {
      const std::string what = "the job store's executor";
      const Result<Json> json = parse_json(*text, what);
      if (!json) return forward_error(json);
      Result<SlurmOptions> stored = slurm_options_from_json(*json, what);
      if (!stored) return forward_error(stored);
      slurm = std::move(*stored);
    }
  }
  if (said.name == "local") slurm.reset();
  if (said.name == "slurm" && !slurm) slurm.emplace();
  if (!slurm && !said.changes.empty()) {
    return fail(ErrorKind::kInput,
                "options of Slurm were given, and the frames are made on this machine: give "
                "--executor slurm, too");
  }
  for (const auto& change : said.changes) change(*slurm);
  return slurm;
}

Status remember_executor(const std::optional<SlurmOptions>& slurm, JobStore& store) {
  return store.set_meta(kExecutorKey, slurm ? canonical_json(to_json(*slurm)) : std::string());
}

void use_executor(const std::optional<SlurmOptions>& slurm, const RunOptions& asked,
                  RunSetup& setup) {
  if (!slurm) return;
  RunOptions tasks = asked;
  // The same program by its whole path: a node's PATH may name another one.
  if (setup.color) tasks.blender = setup.blender.program.name();
  setup.make = runs_by_slurm(*slurm, tasks);
}

}  // namespace seedframe
