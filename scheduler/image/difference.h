// How far two rasters are from each other.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace seedframe {

struct ImageDifference {
  std::int64_t pixels = 0;
  std::int64_t differing = 0;  ///< pixels in which any channel differs, if only by its last bit
  double max = 0.0;            ///< greatest distance of two values
  double rms = 0.0;            ///< over all values of all channels
  /// Greatest number of steps between two values, in the type that they are stored in.
  std::int64_t max_ulp = 0;

  double differing_share() const {
    return pixels > 0 ? static_cast<double>(differing) / static_cast<double>(pixels) : 0.0;
  }
  /// In decibels, of a range of `peak`; infinite when nothing differs.
  double psnr_db(double peak) const;
};

enum class StoredAs { kHalf, kFloat };

/// Of the same size (asserted). NaN equals NaN; against a number it is at an infinite distance.
ImageDifference difference_of(const Image<float>& a, const Image<float>& b, StoredAs stored);
ImageDifference difference_of(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b);
/// Of ids: only `differing` says something.
ImageDifference difference_of(const Image<std::uint16_t>& a, const Image<std::uint16_t>& b);

/// RGB: grey of `a`, darkened, and over it from blue (the last bit) by green to red (a tenth of
/// white or more) how much each pixel differs, on a logarithmic scale.
Image<std::uint8_t> heat_map(const Image<float>& a, const Image<float>& b);

}  // namespace seedframe
