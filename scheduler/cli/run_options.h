// The options that submit and resume share, and what a run needs of them.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"
#include "campaign/run_options.h"
#include "spec/campaign_settings.h"

namespace CLI {
class App;
}

namespace seedframe {

/// Options of the command line that set members of `options`.
void add_run_options(CLI::App& verb, RunOptions& options);

/// Makes the choices that `options` leave open and finds what a run needs, before anything is
/// written. `frames`: how many there are to be rendered.
Result<RunSetup> set_up_run(RunOptions options, const CampaignSettings& settings,
                            std::int64_t frames);

/// "2 × Blender 3.4.1, threads each: 1", or "2 frames at once, threads each: 1, without Blender".
std::string describe(const RunSetup& setup);

}  // namespace seedframe
