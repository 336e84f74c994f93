// How far two images are from each other, in figures that other programs give too.
#pragma once

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// Over all values of all channels.
struct ImageErrors {
  double max = 0.0;
  double mean = 0.0;
  double rms = 0.0;

  /// In decibels, of a range of `peak`; infinite when nothing differs.
  double psnr_db(double peak) const;
};

/// Of the same size and number of channels (asserted), with finite values; with others the errors
/// are not finite either. kEnvironment error: see image_module.h.
Result<ImageErrors> errors_between(const Image<float>& a, const Image<float>& b);

}  // namespace seedframe
