#include "image_files/resampling.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "base/portable_math.h"
#include "image_files/image_module.h"

namespace seedframe {
namespace {

/// IEC 61966-2-1.
double linear_of(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : portable::pow((srgb + 0.055) / 1.055, 2.4);
}

std::array<float, 256> linear_values() {
  std::array<float, 256> values;
  for (int i = 0; i < 256; ++i) values[i] = static_cast<float>(linear_of(i / 255.0));
  return values;
}

/// thresholds[i]: from where on a linear value is nearer to i + 1 than to i, in sRGB.
std::array<float, 255> rounding_thresholds() {
  std::array<float, 255> thresholds;
  for (int i = 0; i < 255; ++i) thresholds[i] = static_cast<float>(linear_of((i + 0.5) / 255.0));
  return thresholds;
}

Image<float> to_linear(const Image<std::uint8_t>& image) {
  static const std::array<float, 256> linear_of = linear_values();
  Image<float> linear(image.width, image.height, image.channels);
  std::transform(image.values.begin(), image.values.end(), linear.values.begin(),
                 [](std::uint8_t value) { return linear_of[value]; });
  return linear;
}

Image<std::uint8_t> to_srgb(const Image<float>& linear) {
  static const std::array<float, 255> thresholds = rounding_thresholds();
  Image<std::uint8_t> image(linear.width, linear.height, linear.channels);
  std::transform(linear.values.begin(), linear.values.end(), image.values.begin(), [](float value) {
    const auto above = std::upper_bound(thresholds.begin(), thresholds.end(), value);
    return static_cast<std::uint8_t>(above - thresholds.begin());
  });
  return image;
}

/// Catmull-Rom goes through the pixels, so it leaves a direction alone that keeps its size.
const char* filter_for(int from, int to) { return to < from ? "mitchell" : "catmull-rom"; }

image_module::FloatPixels pixels_of(Image<float>& image) {
  return {image.width, image.height, image.channels, image.values.data()};
}

}  // namespace

Result<Image<std::uint8_t>> resampled(const Image<std::uint8_t>& image, int width, int height) {
  assert(image.channels == 3 && image.width > 0 && image.height > 0 && width > 0 && height > 0);
  if (image.width == width && image.height == height) return image;
  const Result<const image_module::Table*> library = image_module_table();
  if (!library) return forward_error(library);
  Image<float> linear = to_linear(image);
  Image<float> out(width, height, image.channels);
  const image_module::FloatPixels from = pixels_of(linear);
  const image_module::FloatPixels to = pixels_of(out);
  image_module::Fault fault;
  if (!(*library)->resize(&from, &to, filter_for(image.width, width),
                          filter_for(image.height, height), &fault)) {
    return fail(ErrorKind::kEnvironment, "cannot resize an image: {}", fault.text);
  }
  return to_srgb(out);
}

}  // namespace seedframe
