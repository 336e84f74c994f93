#include "slurm/slurm_factory.h"

#include "slurm/slurm_run.h"

namespace seedframe {

MakeRun runs_by_slurm(const SlurmOptions& options, const RunOptions& asked) {
  return [options, asked](Campaign& campaign, const PreparedCampaign& prepared,
                          Provenance& provenance, const RunSetup& setup, RunObserver& observer) {
    return std::make_unique<SlurmRun>(campaign, prepared, provenance, setup, observer, options,
                                      asked);
  };
}

}  // namespace seedframe
