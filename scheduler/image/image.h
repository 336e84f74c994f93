// A raster in memory.
#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

namespace seedframe {

/// Row-major, channels interleaved, row 0 on top.
template <class T>
struct Image {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<T> values;  ///< width · height · channels

  Image() = default;
  Image(int w, int h, int c = 1)
      : width(w),
        height(h),
        channels(c),
        values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
               static_cast<std::size_t>(c)) {}

  T& at(int row, int column, int channel = 0) { return values[index(row, column, channel)]; }
  const T& at(int row, int column, int channel = 0) const {
    return values[index(row, column, channel)];
  }

 private:
  std::size_t index(int row, int column, int channel) const {
    assert(row >= 0 && row < height && column >= 0 && column < width);
    return (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(column)) *
               static_cast<std::size_t>(channels) +
           static_cast<std::size_t>(channel);
  }
};

}  // namespace seedframe
