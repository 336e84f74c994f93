// What noise leaves of the edges of objects, by which a detector finds them.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace seedframe {

/// Over the pairs of neighbours in a row or a column that have different ids. A pair's contrast is
/// the luminance (Rec. 709) of its one side less that of the other; a side is the pixel of the pair
/// and the one behind it, away from the edge, if that has the same id. In the unit of the pictures:
/// scene-linear, or 8-bit codes.
struct EdgeError {
  std::int64_t pairs = 0;    ///< that are compared; all else is 0 (kept: 1) if there is none
  double contrast = 0.0;     ///< mean of the reference's contrasts without their signs
  double mean_square = 0.0;  ///< of the rendering's contrast less the reference's
  /// The rendering's contrasts, with the reference's signs, summed, over the sum of the
  /// reference's: noise leaves it at 1, blur lowers it. 1 if the reference has no contrast.
  double kept = 1.0;

  /// RMS of the rendering's contrast less the reference's.
  double noise() const;
  /// How many times the noise the contrast is; infinite without noise.
  double signal_to_noise() const;
};

/// Of the same size, with 3 or 4 channels, alpha is ignored; `ids` has one channel (asserted).
/// Pairs with a value that is NaN or infinite, in either picture, are left out.
EdgeError edge_error(const Image<float>& rendering, const Image<float>& reference,
                     const Image<std::uint16_t>& ids);
EdgeError edge_error(const Image<std::uint8_t>& rendering, const Image<std::uint8_t>& reference,
                     const Image<std::uint16_t>& ids);

}  // namespace seedframe
