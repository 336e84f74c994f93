// A frame as a simple shading shows it: the colours and textures of matt surfaces, the light of
// lamps with their shadows, of an environment map and of one surface on the next. No reflections:
// nothing of it is rendered (docs/formats/stream.md has the list).
#pragma once

#include <cstdint>
#include <vector>

#include "base/error.h"
#include "image/image.h"
#include "preview/shading_images.h"
#include "scene/expanded_frame.h"
#include "twin/twin.h"

namespace seedframe {

struct Shading {
  Image<float> light;             ///< RGB, scene-linear
  std::vector<float> brightness;  ///< of some points of surfaces
};

/// Of `spec`, which is the frame's or a view of it; each pixel is the mean of four points. Errors:
/// an image that cannot be read (kInput, kEnvironment), and those of the tracer.
Result<Shading> shaded(const FrameSpec& spec, const ExpandedFrame& frame, TwinTracer& tracer,
                       ShadingImages& images);

/// What makes the brightness of lit surfaces a middle one, for scenes of any unit of light: a
/// factor for DisplayCurve.
double exposure_for(const std::vector<Shading>& shadings);

}  // namespace seedframe
