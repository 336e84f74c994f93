// One number for how far a rendering is from its reference.
#pragma once

#include <string>
#include <vector>

#include "image/rendering_error.h"

namespace seedframe {

/// Less is better; 0 is the reference. docs/error_metrics.md says what each is.
struct Measure {
  const char* key;    ///< "rmse8"
  const char* label;  ///< "RMSE, codes of 8 bits"
  double (*of)(const RenderingError& error);
};

/// rmse8, relmse, flip, and what they leave out: mrse, dissimilarity (1 − SSIM), edge noise.
const std::vector<Measure>& measures();
/// One of these by its key (asserted).
const Measure& measure_named(const std::string& key);

}  // namespace seedframe
