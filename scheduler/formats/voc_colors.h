// The colour map of Pascal VOC.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace seedframe {

/// Colour of an index, RGB: its bits in threes, the lowest into the highest bits of red, green and
/// blue (VOC development kit, VOClabelcolormap).
constexpr std::array<std::uint8_t, 3> voc_color(std::size_t index) {
  std::array<std::uint8_t, 3> color{};
  for (int bit = 7; bit >= 0; --bit, index >>= 3) {
    for (std::size_t c = 0; c < color.size(); ++c) {
      color[c] = static_cast<std::uint8_t>(color[c] | ((index >> c) & 1U) << bit);
    }
  }
  return color;
}

}  // namespace seedframe
