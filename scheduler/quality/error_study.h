// Run time against error, measured: pilot frames of a campaign rendered in many ways, each compared
// with what the frame would be with endless samples.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/run_options.h"
#include "image/rendering_error.h"
#include "quality/variation.h"
#include "scene/prepared_campaign.h"

namespace seedframe {

struct ErrorStudyWishes {
  int frames = 3;                ///< pilots, spread over the campaign
  int most_samples = 1024;       ///< of the variations
  int reference_samples = 1024;  ///< of a reference, both halves together
  /// Seconds of the clock. What does not fit is left out, the least telling variations first; a
  /// reference takes half of it at most.
  double budget_s = 600.0;
};

/// One frame rendered in one way.
struct MeasuredFrame {
  double cpu_s = 0.0;    ///< of all threads of the worker
  double wall_s = 0.0;   ///< of the worker
  RenderingError error;  ///< less what is the reference's own
};

struct MeasuredVariation {
  Variation variation;
  std::vector<MeasuredFrame> frames;  ///< in the order of the pilots; empty when left out
  std::string left_out;               ///< why, or empty

  /// Means over the frames; of squares, so that errors are roots of means.
  double cpu_s() const;
  double wall_s() const;
  RenderingError error() const;
};

struct SceneStudy {
  std::string name;  ///< of the campaign
  int width = 0, height = 0;
  std::vector<std::int64_t> frames;  ///< the pilots
  int reference_samples = 0;         ///< both halves together
  double reference_cpu_s = 0.0;      ///< of a frame's, mean
  /// What of an error is a reference's own, before it is subtracted: mean over the pilots.
  ReferenceVariance reference;
  std::vector<MeasuredVariation> variations;

  const MeasuredVariation* find(const std::string& variation) const;
};

/// Called before each rendering, from one thread.
using OnRendering = std::function<void(const std::string& variation, std::int64_t frame)>;

/// `prepared` is of the source as the user has it; the setup's workers render, and should be one,
/// so that it has seen all meshes and images before anything is timed. Files are written into
/// `scratch`. kInput: nothing is rendered in this campaign, or it has fewer frames than are wished
/// for; kEnvironment: no worker; kRender: a reference could not be rendered, or did not fit into
/// the budget.
Result<SceneStudy> study_errors(const PreparedCampaign& prepared, const RunSetup& setup,
                                const std::filesystem::path& scratch,
                                const ErrorStudyWishes& wishes, const OnRendering& on_rendering);

/// Indices of `count` frames of `all`, at equal distances, the first and last half a distance from
/// the ends.
std::vector<std::int64_t> pilot_frames(std::int64_t all, int count);

}  // namespace seedframe
