// A rectangle of an image.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace seedframe {

/// Columns [x, x + width) of rows [y, y + height), all channels; they must be in the image.
Image<std::uint8_t> cropped(const Image<std::uint8_t>& image, int x, int y, int width, int height);

}  // namespace seedframe
