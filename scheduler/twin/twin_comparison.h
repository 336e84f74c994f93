// Whether Blender rendered what its twin says: the index pass against the twin, pixel by pixel.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "image/image.h"
#include "spec/frame_spec.h"
#include "spec/twin_check.h"
#include "twin/twin.h"

namespace seedframe {

struct TwinVerdict {
  TwinTally tally;
  /// Empty when the images agree well enough; else what is wrong and with which instance.
  std::string complaint;
};

/// What rounding may make of a pixel.
struct Rounding {
  using Test = std::function<bool(int row, int column, std::uint16_t id)>;
  Test grazes;     ///< whether the twin sees an id very near the pixel's centre; Twin::grazes
  Test coincides;  ///< whether an id's surface is where the twin's is; Twin::coincides
};

/// By the twin, which must outlive it.
Rounding rounding_of(const Twin& twin);

/// Both images are of the spec's size. What `rounding` lacks is nowhere so. Pixels where surfaces
/// coincide are told with those of edges, and are no complaint.
TwinVerdict compare_with_twin(const FrameSpec& spec, const Image<std::uint16_t>& rendered,
                              const Image<std::uint16_t>& twin, const TwinTolerance& tolerance,
                              const Rounding& rounding = {});

/// Grey: 0 where the images agree, 64 where surfaces coincide, 128 at edges, 255 inside.
Image<std::uint8_t> difference_image(const Image<std::uint16_t>& rendered,
                                     const Image<std::uint16_t>& twin,
                                     const Rounding& rounding = {});

}  // namespace seedframe
