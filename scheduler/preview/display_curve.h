// Light as a display shows it, about as Blender's views do, without Blender's tables.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "image/image.h"
#include "spec/image_settings.h"

namespace seedframe {

/// "Standard" is sRGB, "Raw" is light itself; all others are taken for "Filmic", whose looks are,
/// of greys up to two stops above 0.18, within 5 codes of x^k / (x^k + 0.18^k), and within 12
/// above. A gamma is applied, the display is taken for sRGB.
class DisplayCurve {
 public:
  /// Light is multiplied by `exposure`; that of the settings is left aside.
  DisplayCurve(const ImageSettings& settings, double exposure);

  /// What is no number is black.
  std::uint8_t code(float light) const;
  /// Of all values.
  Image<std::uint8_t> display(const Image<float>& light) const;

 private:
  std::vector<std::uint8_t> codes_;  ///< by the leading bits of exposed light
  float exposure_;
};

}  // namespace seedframe
