#include "image/resize.h"

#include <algorithm>
#include <cassert>
#include <new>

#define STB_IMAGE_RESIZE_IMPLEMENTATION
#define STB_IMAGE_RESIZE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <stb/stb_image_resize.h>
#pragma GCC diagnostic pop

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

Image<std::uint8_t> resized(const Image<std::uint8_t>& image, int width, int height) {
  assert(image.channels == 3);
  if (image.width == width && image.height == height) return image;
  Image<std::uint8_t> out(width, height, image.channels);
  const int done =
      stbir_resize_uint8_srgb(image.values.data(), image.width, image.height, 0, out.values.data(),
                              width, height, 0, image.channels, STBIR_ALPHA_CHANNEL_NONE, 0);
  if (done == 0) throw std::bad_alloc();  // its only failure
  return out;
}

}  // namespace seedframe
