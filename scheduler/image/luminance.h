// The brightness of a colour.
#pragma once

namespace seedframe {

/// Rec. 709 weights (ITU-R BT.709-6, 3.2): luminance of linear RGB with sRGB's primaries, in the
/// unit of the channels; luma of display RGB, in codes.
constexpr double luminance(double red, double green, double blue) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

}  // namespace seedframe
