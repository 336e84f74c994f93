// Pictures by a formula in whole numbers, the same as in
// tests/image/reference/metrics_reference.py, which tells what other programs measure in them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "image/image.h"

namespace seedframe {

/// Calls `code` with row, column and channel.
template <class Code>
Image<std::uint8_t> picture_by(int width, int height, Code code) {
  Image<std::uint8_t> picture(width, height, 3);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      for (int channel = 0; channel < 3; ++channel) {
        picture.at(row, column, channel) =
            static_cast<std::uint8_t>(std::clamp(code(row, column, channel), 0, 255));
      }
    }
  }
  return picture;
}

inline int reference_code(int row, int column, int channel) {
  const int block = (row / 12 + column / 16) % 2;
  return 90 * block + (2 * row + column + 50 * channel) % 120 + 20;
}

inline Image<std::uint8_t> reference_picture(int width, int height) {
  return picture_by(width, height, reference_code);
}

inline Image<std::uint8_t> noisy_picture(int width, int height, int amplitude) {
  return picture_by(width, height, [amplitude](int row, int column, int channel) {
    const auto key = static_cast<std::uint64_t>(row) * 73856093U ^
                     static_cast<std::uint64_t>(column) * 19349663U ^
                     static_cast<std::uint64_t>(channel) * 83492791U;
    const auto hashed = static_cast<std::uint32_t>(key * 2654435761U);
    const int noise = static_cast<int>((hashed >> 16U) % static_cast<unsigned>(2 * amplitude + 1));
    return reference_code(row, column, channel) + noise - amplitude;
  });
}

/// Red and blue exchanged.
inline Image<std::uint8_t> recolored_picture(int width, int height) {
  return picture_by(width, height, [](int row, int column, int channel) {
    return reference_code(row, column, 2 - channel);
  });
}

inline Image<float> linear_of(const Image<std::uint8_t>& display) {
  Image<float> linear(display.width, display.height, display.channels);
  std::transform(display.values.begin(), display.values.end(), linear.values.begin(),
                 [](std::uint8_t code) {
                   const float v = static_cast<float>(code) / 64.0F;
                   return v * v;  // exact
                 });
  return linear;
}

/// The same pixels with a fourth channel of any values.
template <class T>
Image<T> with_alpha(const Image<T>& rgb) {
  Image<T> rgba(rgb.width, rgb.height, 4);
  for (int row = 0; row < rgb.height; ++row) {
    for (int column = 0; column < rgb.width; ++column) {
      for (int channel = 0; channel < 3; ++channel) {
        rgba.at(row, column, channel) = rgb.at(row, column, channel);
      }
      rgba.at(row, column, 3) = static_cast<T>(row + column);
    }
  }
  return rgba;
}

}  // namespace seedframe
