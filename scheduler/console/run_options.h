// The options that submit, resume and audit share.
#pragma once

#include <cstdint>

#include "base/error.h"
#include "campaign/run_options.h"
#include "spec/campaign_settings.h"

namespace CLI {
class App;
}

namespace seedframe {

/// Options of the command line that set members of `options`.
void add_run_options(CLI::App& verb, RunOptions& options);

/// set_up_run with what belongs to this program and its user.
Result<RunSetup> set_up_run(const RunOptions& options, const CampaignSettings& settings,
                            std::int64_t frames);
void print_notes(const RunSetup& setup);

}  // namespace seedframe
