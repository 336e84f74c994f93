// Structural similarity of two pictures.
#pragma once

#include <cstdint>
#include <optional>

#include "image/image.h"

namespace seedframe {

/// Mean SSIM of display RGB (8 bits; 3 or 4 channels, alpha is ignored), at most 1, which is only
/// of equal pictures: Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error
/// Visibility to Structural Similarity" (2004), eq. 13, with their constants: K1 0.01, K2 0.03,
/// range 255, a Gaussian window of 11 × 11 pixels and σ 1.5; of each channel by itself, then their
/// mean. Only windows that lie inside of the picture count; nothing where there is none, for a
/// picture that is less than 11 pixels wide or high. Of the same size (asserted).
std::optional<double> ssim(const Image<std::uint8_t>& rendering,
                           const Image<std::uint8_t>& reference);

}  // namespace seedframe
