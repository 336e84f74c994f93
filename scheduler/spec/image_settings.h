// How a picture is made from the combined pass.
#pragma once

#include <string>

namespace seedframe {

/// Names as in the OCIO config; the exposure multiplies by 2^stops before, the gamma applies after
/// the view.
struct ImageSettings {
  std::string display = "sRGB";
  std::string view = "Filmic";
  std::string look = "None";  ///< "None" or empty for none
  double exposure_stops = 0.0;
  double gamma = 1.0;
};

}  // namespace seedframe
