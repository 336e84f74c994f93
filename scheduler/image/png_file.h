// PNG in and out: 8-bit RGB and 8- or 16-bit grey, no time chunk, no gamma tricks: the same pixels
// give the same bytes (with the same zlib).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// The bytes of a PNG file. image.channels: 1 (grey) or 3 (RGB, marked sRGB) for uint8; 1 for
/// uint16.
std::string encode_png(const Image<std::uint8_t>& image);
std::string encode_png(const Image<std::uint16_t>& image);

/// kCorrupt errors name the file: missing, cut, damaged, or of another depth than asked for.
Result<Image<std::uint8_t>> read_png8(const std::filesystem::path& path);
Result<Image<std::uint16_t>> read_png16(const std::filesystem::path& path);

}  // namespace seedframe
