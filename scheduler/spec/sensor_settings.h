// What a camera's sensor and its electronics make of a picture.
#pragma once

#include <array>
#include <cstdint>

namespace seedframe {

/// In the order in which they happen; each is off at its default. Light is told as a share of that
/// which gives white.
struct SensorSettings {
  double blur_px = 0.0;  ///< of the lens: deviation of a Gaussian
  double exposure_stops = 0.0;
  double full_well = 0.0;                              ///< electrons that white frees; 0: no noise
  double read_noise = 0.0;                             ///< deviation, electrons
  std::uint32_t seed = 0;                              ///< of the noise, 31 bits
  std::array<double, 3> white_balance{1.0, 1.0, 1.0};  ///< gains of red, green and blue
  int jpeg_quality = 0;                                ///< 1 … 100; 0: no JPEG

  bool operator==(const SensorSettings&) const = default;
};

}  // namespace seedframe
