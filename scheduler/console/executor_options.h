// Where a campaign's frames are made: on this machine, or by a Slurm cluster.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/run_options.h"
#include "slurm/slurm_options.h"
#include "store/job_store.h"

namespace CLI {
class App;
}

namespace seedframe {

struct ExecutorOptions {
  std::string name;                                         ///< empty: not said
  std::vector<std::function<void(SlurmOptions&)>> changes;  ///< what else was said
};

void add_executor_options(CLI::App& verb, ExecutorOptions& options);

/// What `store` remembers (none: a campaign that is only planned), changed by what was said; none:
/// this machine. kInput: options of Slurm for this machine.
Result<std::optional<SlurmOptions>> choose_executor(const ExecutorOptions& said,
                                                    const JobStore* store);
/// For the next run.
Status remember_executor(const std::optional<SlurmOptions>& slurm, JobStore& store);

/// `asked`: the options of which `setup` was made.
void use_executor(const std::optional<SlurmOptions>& slurm, const RunOptions& asked,
                  RunSetup& setup);

}  // namespace seedframe
