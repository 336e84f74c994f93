// Another number of pixels for an image.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace seedframe {

/// Columns [x, x + width) of rows [y, y + height), all channels; they must be in the image.
Image<std::uint8_t> cropped(const Image<std::uint8_t>& image, int x, int y, int width, int height);

/// An RGB image in sRGB, resampled in linear light: a Mitchell filter where it becomes smaller,
/// Catmull-Rom where it becomes larger. The shape is not kept.
Image<std::uint8_t> resized(const Image<std::uint8_t>& image, int width, int height);

}  // namespace seedframe
