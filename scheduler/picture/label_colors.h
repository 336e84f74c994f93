// Colours of classes and of their instances: the same for the same labels in every picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace seedframe {

/// Red, green, blue, 0 to 1, as a display has them (sRGB).
using DisplayColor = std::array<double, 3>;

/// Of a category (1-based); 0, which is a distractor's, is grey. The first eight differ for most
/// eyes, also by their lightness; those after them are spread over hues and lightnesses.
DisplayColor class_color(int category);

/// A lighter or darker shade of its class's colour: of the `nth` instance (from 0) of its class in
/// a frame. Five differ clearly, then they begin again.
DisplayColor instance_color(int category, std::size_t nth);

/// Black or white: what is read more easily on a colour.
DisplayColor ink_on(const DisplayColor& background);

/// 0 to 1 (what is beyond is clamped) to dark blue … yellow, evenly for the eye, also where red and
/// green look alike (viridis of matplotlib, by van der Walt and Smith, 2015).
DisplayColor depth_color(double share);

/// 8 bits a channel.
std::array<std::uint8_t, 3> color_bytes(const DisplayColor& color);

}  // namespace seedframe
