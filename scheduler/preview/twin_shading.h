// A frame as a simple shading shows it: what is where, of about which colour, lit from where. No
// shadows, no reflections, no textures: nothing of it is rendered.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "scene/expanded_frame.h"
#include "twin/twin.h"

namespace seedframe {

struct Shading {
  Image<float> light;             ///< RGB, scene-linear
  std::vector<float> brightness;  ///< of some pixels in which there is a surface
};

/// `twin` is of `spec`, a view of the frame, and was traced with normals and depth.
Shading shaded(const FrameSpec& spec, const Affine& world_from_camera, const Twin& twin);

/// What makes the brightness of lit surfaces a middle one, for scenes of any unit of light: the
/// factor for shaded_display.
double exposure_for(const std::vector<Shading>& shadings);

/// RGB for a display.
Image<std::uint8_t> shaded_display(const Image<float>& light, double exposure);

}  // namespace seedframe
