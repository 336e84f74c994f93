// How many samples adaptive sampling took, from the pass that Cycles writes of it.
#pragma once

#include "image/image.h"

namespace seedframe {

/// Cycles looks at the errors of pixels after every so many samples.
inline constexpr int kSamplesBetweenLooks = 16;

/// Mean over the pixels. The pass has each pixel's share of the samples of the pixel that had most
/// of them, of which the file does not say how many they are: it is the least number of which all
/// shares are whole looks, or else `most_samples`, where pixels that never were good enough stop.
double mean_samples(const Image<float>& shares, int most_samples);

}  // namespace seedframe
