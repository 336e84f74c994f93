// Image files as light: what is looked at from further away than it was made for.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// RGB, linear: integers are sRGB, EXR and HDR are as they are. Grey has three equal channels,
/// alpha is ignored, what is negative or no number is 0. An image of more pixels a side than
/// `most_px` is reduced by a whole factor, a pixel being the mean of those that it stands for.
/// Errors: of reading the file, and of visit_image (image_files/image_reader.h).
Result<Image<float>> read_linear_image(const std::filesystem::path& file, int most_px);

/// IEC 61966-2-1, the nearest code of 8 bits; light beyond 0 to 1 has the code of the end.
std::uint8_t srgb_code(float light);
/// The light of each code.
const std::array<float, 256>& srgb_lights();

}  // namespace seedframe
