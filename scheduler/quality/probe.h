// A cheap or a careful look at a frame: what a calibration renders.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/run_options.h"
#include "image/rendering_error.h"
#include "scene/prepared_campaign.h"
#include "spec/quality_wish.h"

namespace seedframe {

struct Probe {
  std::int64_t frame = 0;
  RenderChoice choice;
  /// Gives the probe random numbers of its own: probes of the same frame that are compared differ
  /// in it.
  std::string stream;
  bool quarter = false;  ///< half as wide and half as high
};

struct ProbedFrame {
  Picture picture;
  double mean_samples = 0.0;  ///< that a pixel had
  double cpu_s = 0.0;
};

/// The frame's spec as the probe wants it rendered: no depth, no normals, no clamps but the
/// config's.
Result<ExpandedFrame> expand_probe(const PreparedCampaign& prepared, const Probe& probe);

/// A camera that sees the same with half as many pixels each way (rounded up).
void halve_resolution(FrameSpec& spec);

/// Renders them in order; each is told once, from one thread, with a picture or with why there is
/// none.
Status render_probes(const std::vector<Probe>& probes, const PreparedCampaign& prepared,
                     const RunSetup& setup, const std::filesystem::path& scratch,
                     const std::function<void(std::int64_t probe)>& before,
                     const std::function<void(std::size_t probe, Result<ProbedFrame>)>& told);

}  // namespace seedframe
