// Rectangles of images.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "base/pixel_rect.h"
#include "image/image.h"

namespace seedframe {

/// A rectangle of an image, all channels; it must be inside.
template <class T>
Image<T> cropped(const Image<T>& image, const PixelRect& rect) {
  assert(rect.x >= 0 && rect.y >= 0 && rect.end_x() <= image.width && rect.end_y() <= image.height);
  Image<T> part(rect.width, rect.height, image.channels);
  const auto row_values = static_cast<std::ptrdiff_t>(rect.width) * image.channels;
  for (int row = 0; row < rect.height; ++row) {
    const T* from = &image.at(rect.y + row, rect.x);
    std::copy(from, from + row_values, &part.at(row, 0));
  }
  return part;
}

/// An image with `part` at its place `at`, which must have its size and be inside; every other
/// value is `fill`.
template <class T>
Image<T> placed_at(const Image<T>& part, const PixelRect& at, int width, int height, T fill) {
  assert(part.width == at.width && part.height == at.height);
  assert(at.x >= 0 && at.y >= 0 && at.end_x() <= width && at.end_y() <= height);
  Image<T> whole(width, height, part.channels);
  std::fill(whole.values.begin(), whole.values.end(), fill);
  const auto row_values = static_cast<std::ptrdiff_t>(part.width) * part.channels;
  for (int row = 0; row < part.height; ++row) {
    const T* from = &part.at(row, 0);
    std::copy(from, from + row_values, &whole.at(at.y + row, at.x));
  }
  return whole;
}

/// Every value that is not in the rectangle becomes `fill`.
template <class T>
void fill_outside(Image<T>& image, const PixelRect& inside, T fill) {
  auto value = image.values.begin();
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column, value += image.channels) {
      if (!inside.contains(column, row)) std::fill_n(value, image.channels, fill);
    }
  }
}

}  // namespace seedframe
