// Which passes a frame needs, and from which rendering of its scene each comes.
#pragma once

#include "spec/frame_spec.h"

namespace seedframe {

/// Beside the combined and the index pass, which every rendered frame has.
struct PassPlan {
  bool depth = false;
  bool normal = false;
  /// A lens disturbs all passes. So a worker renders the frame once more, without it and with one
  /// sample: all but the combined pass comes from there.
  bool sharp_rendering = false;
};

PassPlan plan_passes(const FrameSpec& spec);

}  // namespace seedframe
