// A run on a Slurm cluster in place of one on this machine.
#pragma once

#include "campaign/run_options.h"
#include "slurm/slurm_options.h"

namespace seedframe {

/// For RunSetup::make. `asked`: the run's options as they were given, of `setup`.
MakeRun runs_by_slurm(const SlurmOptions& options, const RunOptions& asked);

}  // namespace seedframe
