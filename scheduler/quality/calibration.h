// What each frame of a campaign is to be rendered with, so that it is at most as wrong as the
// config wants, at the least cost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "base/error.h"
#include "campaign/run_options.h"
#include "scene/prepared_campaign.h"
#include "spec/quality_wish.h"

namespace seedframe {

struct Calibration {
  RenderChoices choices;
  double pilots_cpu_s = 0.0;       ///< whatever the number of frames
  double scouts_cpu_s = 0.0;       ///< of all frames
  std::int64_t beyond_reach = 0;   ///< frames for which render.samples are not enough, as predicted
  std::int64_t denoised = 0;       ///< frames
  std::vector<std::string> notes;  ///< that the user should read, a sentence each
};

/// Called before each rendering, with how many there have been and are to be.
using OnCalibrating = std::function<void(std::int64_t done, std::int64_t of)>;

/// Looks at every one of the campaign's first `frames` frames with two renderings of few samples
/// and a quarter of its pixels, whose difference is its noise; and at a few pilots with many more,
/// from which follows what error comes of such noise with which settings (error_model.h). The
/// choices depend on the config, its seed and what Blender renders, on no clock, and on no order.
/// Renders into `scratch`. kInput: `prepared` has no wish for quality; kRender: too few pilots
/// could be rendered; else those of render_aside.
Result<Calibration> calibrate(const PreparedCampaign& prepared, std::int64_t frames,
                              const RunSetup& setup, const std::filesystem::path& scratch,
                              const OnCalibrating& on_calibrating);

}  // namespace seedframe
