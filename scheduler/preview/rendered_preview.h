// A look at some frames of a config, rendered small and with few samples; and what the whole
// campaign will take, told by them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/run_options.h"
#include "preview/previewed_frame.h"
#include "scene/prepared_campaign.h"

namespace seedframe {

struct PreviewWish {
  std::vector<std::int64_t> frames;
  int most_width = 320;  ///< pixels of a picture
  int most_samples = 8;  ///< of its pixels
};

/// What rendering all frames will take: of pictures that had fewer pixels and samples, so a
/// forecast by pilots (report/forecast.h) is nearer.
struct CampaignCosts {
  double wall_s = 0.0;      ///< from the start of the workers to the last frame
  double frame_s = 0.0;     ///< of one worker for a frame
  bool is_at_most = false;  ///< pixels may be finished with fewer samples
};

struct RenderedPreview {
  std::vector<PreviewedFrame> frames;
  std::vector<std::string> failures;   ///< of frames that are missing, a line each
  std::optional<CampaignCosts> costs;  ///< none: too little was rendered to tell
  int samples = 0;                     ///< of the pictures
  bool denoised = false;
};

/// Renders in `scratch`, which is made, with the setup of the campaign's own run; denoised where
/// the Blender can. `told` hears how many of how many renderings there are.
/// Errors: those of render_aside.
Result<RenderedPreview> preview_by_rendering(
    const PreparedCampaign& prepared, const RunSetup& setup, const PreviewWish& wish,
    const std::filesystem::path& scratch,
    const std::function<void(std::int64_t done, std::int64_t all)>& told);

}  // namespace seedframe
