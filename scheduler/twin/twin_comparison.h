// Whether Blender rendered what its twin says: the index pass against the twin, pixel by pixel.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "image/image.h"
#include "spec/frame_spec.h"
#include "spec/twin_check.h"

namespace seedframe {

struct TwinVerdict {
  TwinTally tally;
  /// Empty when the images agree well enough; else what is wrong and with which instance.
  std::string complaint;
};

/// Whether the twin sees an id very near a pixel's centre; Twin::grazes.
using Grazes = std::function<bool(int row, int column, std::uint16_t id)>;

/// Both images are of the spec's size. Without `grazes`, no pixel is grazed.
TwinVerdict compare_with_twin(const FrameSpec& spec, const Image<std::uint16_t>& rendered,
                              const Image<std::uint16_t>& twin, const TwinTolerance& tolerance,
                              const Grazes& grazes = {});

/// Grey: 0 where the images agree, 128 at edges, 255 inside.
Image<std::uint8_t> difference_image(const Image<std::uint16_t>& rendered,
                                     const Image<std::uint16_t>& twin, const Grazes& grazes = {});

}  // namespace seedframe
