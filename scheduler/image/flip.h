// The difference that somebody sees who flips between two pictures.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace seedframe {

/// Of an observer 0.7 m in front of a display that is 0.7 m wide and has 3840 pixels in a row,
/// which is what published values of FLIP mean if they do not say otherwise: about 67.02.
double flip_pixels_per_degree();

/// LDR-FLIP of each pixel, from 0 (nobody sees a difference) to 1: Andersson, Nilsson,
/// Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for Alternating
/// Images" (2020). Of sRGB display pictures (8 bits; 3 or 4 channels, alpha is ignored) of the same
/// size, which may change places, at 1 pixel per degree or more (all asserted).
Image<float> flip_map(const Image<std::uint8_t>& rendering, const Image<std::uint8_t>& reference,
                      double pixels_per_degree = flip_pixels_per_degree());

/// Mean of a map, which is the picture's FLIP; 0 if it has no pixels.
double mean_flip(const Image<float>& map);

}  // namespace seedframe
