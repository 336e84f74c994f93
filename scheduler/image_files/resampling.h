// Another number of pixels for an image.
#pragma once

#include <cstdint>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// An RGB image in sRGB, resampled in linear light: a Mitchell-Netravali filter in a direction in
/// which it becomes smaller, else Catmull-Rom (Mitchell, Netravali: Reconstruction
/// Filters in Computer Graphics, 1988). The shape is not kept. kEnvironment error: see
/// image_module.h.
Result<Image<std::uint8_t>> resampled(const Image<std::uint8_t>& image, int width, int height);

}  // namespace seedframe
