// Everything but the campaign that a run needs, found and checked before anything is written: the
// one place for submit, resume, audit and whoever else runs a campaign.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "cache/frame_cache.h"
#include "campaign/run_options.h"
#include "image/color_management.h"
#include "render/blender_info.h"
#include "spec/campaign_settings.h"

namespace seedframe {

struct Renderer {
  BlenderInfo blender;
  std::shared_ptr<const ColorManagement> color;
};

/// Blender and the colours that it works with, or those that `settings` (if any) name, which are
/// tried first (image/color_trial.h) unless a distribution brought them. With a cache a Blender
/// that is known is not started. kEnvironment errors: no Blender, no colours.
Result<Renderer> find_renderer(const std::string& program, const CampaignSettings* settings,
                               FrameCache* cache);

/// Whether there are the display, view and look that a config asks for; a kInput error names its
/// line.
Status check_view(const CampaignSettings& settings, const ColorManagement& color);

/// What belongs to the program, and to its user.
struct RunPlaces {
  std::filesystem::path scripts;  ///< blender_scripts/
  std::filesystem::path preload;  ///< the library for workers, see environment_of
  std::filesystem::path cache;    ///< folder of the FrameCache; empty: there is none
};

/// Makes the choices that `options` leave open, and finds Blender and its colours. `frames`: how
/// many there are to be rendered. kEnvironment errors: no Blender, no library beside the program,
/// no sandbox. What the user should know though nothing is wrong is in the notes.
Result<RunSetup> set_up_run(RunOptions options, const RunPlaces& places,
                            const CampaignSettings& settings, std::int64_t frames);

/// "2 × Blender 3.4.1, threads each: 1", or "2 frames at once, threads each: 1, without Blender",
/// or that others choose.
std::string describe(const RunSetup& setup);

}  // namespace seedframe
