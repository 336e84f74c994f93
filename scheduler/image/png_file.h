// PNG in and out: 8-bit RGB, 8-bit with a palette, and 8- or 16-bit grey, no time chunk, no gamma
// tricks: the same pixels give the same bytes (with the same zlib).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

enum class PngContent {
  kPhoto,   ///< noise; RGB is marked sRGB
  kLabels,  ///< flat regions; RGB are numbers, not colours
};

/// The bytes of a PNG file. image.channels: 1 (grey, always labels) or 3 (RGB) for uint8; 1 for
/// uint16. `level`: of zlib, 0 (none) to 9, with its usual search; none: runs only, which is fast.
std::string encode_png(const Image<std::uint8_t>& image, PngContent content = PngContent::kPhoto,
                       std::optional<int> level = std::nullopt);
std::string encode_png(const Image<std::uint16_t>& image);

using Palette = std::vector<std::array<std::uint8_t, 3>>;  ///< at most 256 colours

/// 8 bits, a palette's index in each pixel; image.channels: 1. Every index must be in the palette.
std::string encode_palette_png(const Image<std::uint8_t>& image, const Palette& palette);

/// kCorrupt errors say `what`: cut, damaged, or of another depth than asked for.
Result<Image<std::uint8_t>> decode_png8(std::string_view bytes, const std::string& what);
Result<Image<std::uint16_t>> decode_png16(std::string_view bytes, const std::string& what);
/// The indices of an image with a palette, and the palette.
Result<Image<std::uint8_t>> decode_palette_png(std::string_view bytes, const std::string& what,
                                               Palette& palette);

/// The same, of a file; one that is missing is a kCorrupt error too.
Result<Image<std::uint8_t>> read_png8(const std::filesystem::path& path);
Result<Image<std::uint16_t>> read_png16(const std::filesystem::path& path);

}  // namespace seedframe
