// The hash of a raster's pixels, whatever file they are stored in (docs/formats/images.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "image/image.h"

namespace seedframe {

/// SHA-256 over "seedframe-pixels-1\n<width> <height> <type> <channels>\n" (channels such as
/// "R,G,B,A", type "half", "float", "uint8" or "uint16") and then the values, little-endian, row by
/// row, -0 as it is, every NaN as the one quiet NaN. Values of type "half" are hashed as the floats
/// they convert to.
std::string pixel_hash(const Image<float>& image, std::string_view type, std::string_view channels);
std::string pixel_hash(const Image<std::uint8_t>& image, std::string_view channels);
std::string pixel_hash(const Image<std::uint16_t>& image, std::string_view channels);

}  // namespace seedframe
