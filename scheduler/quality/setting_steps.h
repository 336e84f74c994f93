// The steps in which settings are chosen: no prediction of an error is better than these.
#pragma once

namespace seedframe {

/// Of adaptive sampling. Above the coarsest nothing changes.
inline constexpr double kCoarsestThreshold = 0.4;
inline constexpr double kFinestThreshold = 0.001;
/// Of a pixel: with so many, Cycles looks at its error after 32, 48, 64, … samples.
inline constexpr int kLeastAdaptiveSamples = 16;

/// The next of 1, 2, 3, 4, 6, 8, 12, 16, 24, …
int rounded_samples(double samples);

/// The next finer threshold that is a multiple of a quarter of an octave below the coarsest.
double rounded_threshold(double threshold);

}  // namespace seedframe
