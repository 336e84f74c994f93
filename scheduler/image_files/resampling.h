// Another number of pixels for an image.
#pragma once

#include <cstdint>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// An RGB image in sRGB, resampled in linear light. In a direction in which it becomes smaller a
/// pixel is the mean of what it covers, each old pixel by the share of it that is covered; in one
/// in which it grows, Catmull-Rom goes through the old pixels. The shape is not kept. kEnvironment
/// error: see image_module.h.
Result<Image<std::uint8_t>> resampled(const Image<std::uint8_t>& image, int width, int height);

}  // namespace seedframe
