#include "spec/scaled_view.h"

#include <algorithm>
#include <cmath>

namespace seedframe {

FrameSpec scaled_view(FrameSpec spec, double scale) {
  RenderSettings& render = spec.render;
  render.width = std::max(1, static_cast<int>(std::lround(render.width * scale)));
  render.height = std::max(1, static_cast<int>(std::lround(render.height * scale)));
  render.region.reset();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    spec.camera.focal_px[axis] *= scale;
    spec.camera.center_px[axis] = (spec.camera.center_px[axis] + 0.5) * scale - 0.5;
  }
  return spec;
}

}  // namespace seedframe
