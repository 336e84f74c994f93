#include "console/choose_settings.h"

#include <algorithm>
#include <cstdio>

#include "console/say.h"
#include "console/temporary_folder.h"
#include "quality/calibration.h"

namespace seedframe {
namespace {

/// "2 to 96 samples, at most 24 for half of the frames".
std::string samples_text(const RenderChoices& choices) {
  std::vector<int> samples;
  for (const auto& [frame, choice] : choices) samples.push_back(choice.samples);
  std::sort(samples.begin(), samples.end());
  return fmt::format("{} to {} samples, at most {} for half of the frames", samples.front(),
                     samples.back(), samples[(samples.size() - 1) / 2]);
}

}  // namespace

Status choose_settings(PreparedCampaign& prepared, const RunSetup& setup) {
  const bool quiet = setup.options.quiet;
  const Result<TemporaryFolder> scratch = TemporaryFolder::make("seedframe-calibrate");
  if (!scratch) return forward_error(scratch);
  std::int64_t all = 0;
  Result<Calibration> calibration =
      calibrate(prepared, prepared.expander.frame_count(), setup, scratch->path(),
                [&](std::int64_t done, std::int64_t of) {
                  all = of;
                  if (!quiet && done % 10 == 0) {
                    std::fprintf(stderr, "\rcalibrating: %lld of %lld small renderings",
                                 static_cast<long long>(done), static_cast<long long>(of));
                  }
                });
  if (!calibration) return forward_error(calibration);
  if (!quiet) {
    std::fprintf(stderr,
                 "\rcalibrated by %lld small renderings (pilots %.1f, scouts %.1f CPU s): %s%s\n",
                 static_cast<long long>(all), calibration->pilots_cpu_s, calibration->scouts_cpu_s,
                 samples_text(calibration->choices).c_str(),
                 calibration->denoised > 0
                     ? fmt::format(", {} frames denoised", calibration->denoised).c_str()
                     : "");
  }
  for (const std::string& note : calibration->notes) {
    say_aside("seedframe: note: {}\n", note);
  }
  if (calibration->beyond_reach > 0) {
    std::fprintf(
        stderr,
        "seedframe: note: of %lld frames the error is likely to be above quality.max_error "
        "even with all render.samples (%d): raise one of them\n",
        static_cast<long long>(calibration->beyond_reach), prepared.settings.render.samples);
  }
  prepared.expander.set_choices(
      std::make_shared<const RenderChoices>(std::move(calibration->choices)));
  return {};
}

}  // namespace seedframe
