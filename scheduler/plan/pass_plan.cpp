#include "plan/pass_plan.h"

namespace seedframe {

PassPlan plan_passes(const FrameSpec& spec) {
  return {.depth = spec.render.depth,
          .normal = spec.render.normal,
          .sharp_rendering = spec.camera.aperture_radius_m > 0.0};
}

}  // namespace seedframe
