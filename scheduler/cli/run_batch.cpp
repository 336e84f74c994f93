// seedframe run-batch: what array tasks of Slurm run.

#include <cstdlib>
#include <memory>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/say.h"
#include "slurm/task_run.h"

namespace seedframe {
namespace {

struct RunBatchArguments {
  std::string folder;
  int batch = 0;
};

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : value;
}

std::string this_node() {
  std::string node = variable("SLURMD_NODENAME");
  if (!node.empty()) return node;
  std::string host(256, '\0');
  ::gethostname(host.data(), host.size() - 1);
  host.resize(host.find('\0'));
  return host;
}

int run_batch(const RunBatchArguments& arguments) {
  TaskOrder order;
  order.submission = arguments.folder;
  order.batch = arguments.batch;
  order.node = this_node();
  order.task = variable("SLURM_ARRAY_JOB_ID") + "_" + variable("SLURM_ARRAY_TASK_ID");
  order.cpus = std::atoi(variable("SLURM_CPUS_PER_TASK").c_str());
  order.places = {seedframe_home() / "blender_scripts", worker_preload(), {}};
  const Result<std::string> outcome = run_task(order);
  if (!outcome) return report(outcome.error());
  say("{}\n", *outcome);
  return kExitOk;
}

}  // namespace

void add_run_batch_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<RunBatchArguments>();
  CLI::App* verb = app.add_subcommand(
      "run-batch", "make one batch of frames for a run by Slurm, whose tasks call this");
  verb->add_option("SUBMISSION", arguments->folder, "folder of the submission, slurm/0001")
      ->required();
  verb->add_option("INDEX", arguments->batch, "index of the task in its array")
      ->required()
      ->check(NotNegative());
  verb->footer("Example: seedframe run-batch results/parts/slurm/0001 17");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return run_batch(*arguments); }); });
}

}  // namespace seedframe
