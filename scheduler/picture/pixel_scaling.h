// Pixels to the size at which they are shown.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace seedframe {

/// Each pixel is the mean, in linear light, of exactly the part of the RGB image (sRGB) that it
/// covers. Neither way larger than the image (asserted).
Image<std::uint8_t> shrunk(const Image<std::uint8_t>& image, int width, int height);

/// `factor` times as wide and high: each pixel a square. Of any number of channels.
Image<std::uint8_t> enlarged(const Image<std::uint8_t>& image, int factor);

}  // namespace seedframe
