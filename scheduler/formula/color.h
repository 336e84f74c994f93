// Colours of a config as linear RGB with Rec.709 primaries.
#pragma once

#include "spec/frame_spec.h"

namespace seedframe {

/// Hue in degrees (any number, wraps), saturation and value in [0, 1], of gamma-encoded sRGB
/// (A. R. Smith, "Color gamut transform pairs", SIGGRAPH 1978), decoded by IEC 61966-2-1.
Rgb linear_from_hsv(double hue_deg, double saturation, double value);

/// The colour of a black body, scaled to luminance 1 (Rec.709 weights), negative parts cut off.
/// Planckian locus by the cubic splines of Kang et al., "Design of advanced color temperature
/// control system", J. Korean Phys. Soc. 41 (2002), valid from 1667 K to 25000 K; outside, clamped.
Rgb linear_from_kelvin(double kelvin);

}  // namespace seedframe
