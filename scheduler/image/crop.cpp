#include "image/crop.h"

#include <algorithm>
#include <cassert>

namespace seedframe {

Image<std::uint8_t> cropped(const Image<std::uint8_t>& image, int x, int y, int width, int height) {
  assert(x >= 0 && y >= 0 && x + width <= image.width && y + height <= image.height);
  Image<std::uint8_t> out(width, height, image.channels);
  for (int row = 0; row < height; ++row) {
    const std::uint8_t* from = &image.at(y + row, x);
    std::copy(from, from + static_cast<std::ptrdiff_t>(width) * image.channels, &out.at(row, 0));
  }
  return out;
}

}  // namespace seedframe
