#include "image_files/resampling.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

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

/// The old pixels of which a new one holds a part, and how much of the new one they make up.
struct Cover {
  int first = 0;
  std::vector<double> shares;
};

/// New pixel i is [i · from, (i + 1) · from) in units of 1/to of an old one: whole numbers, so that
/// the shares are exact.
std::vector<Cover> covers_of(int from, int to) {
  std::vector<Cover> covers(static_cast<std::size_t>(to));
  for (std::int64_t i = 0; i < to; ++i) {
    Cover& cover = covers[static_cast<std::size_t>(i)];
    const std::int64_t begin = i * from;
    const std::int64_t end = begin + from;
    cover.first = static_cast<int>(begin / to);
    for (std::int64_t old = cover.first; old * to < end; ++old) {
      const std::int64_t overlap = std::min(end, (old + 1) * to) - std::max(begin, old * to);
      cover.shares.push_back(static_cast<double>(overlap) / from);
    }
  }
  return covers;
}

Image<float> narrowed(const Image<float>& image, int width) {
  if (width >= image.width) return image;
  const std::vector<Cover> covers = covers_of(image.width, width);
  Image<float> out(width, image.height, image.channels);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Cover& cover = covers[static_cast<std::size_t>(column)];
      for (int channel = 0; channel < image.channels; ++channel) {
        double sum = 0.0;
        int old = cover.first;
        for (const double share : cover.shares) sum += share * image.at(row, old++, channel);
        out.at(row, column, channel) = static_cast<float>(sum);
      }
    }
  }
  return out;
}

Image<float> lowered(const Image<float>& image, int height) {
  if (height >= image.height) return image;
  const std::vector<Cover> covers = covers_of(image.height, height);
  Image<float> out(image.width, height, image.channels);
  for (int row = 0; row < height; ++row) {
    const Cover& cover = covers[static_cast<std::size_t>(row)];
    for (int column = 0; column < image.width; ++column) {
      for (int channel = 0; channel < image.channels; ++channel) {
        double sum = 0.0;
        int old = cover.first;
        for (const double share : cover.shares) sum += share * image.at(old++, column, channel);
        out.at(row, column, channel) = static_cast<float>(sum);
      }
    }
  }
  return out;
}

image_module::FloatPixels pixels_of(Image<float>& image) {
  return {image.width, image.height, image.channels, image.values.data()};
}

}  // namespace

Result<Image<std::uint8_t>> resampled(const Image<std::uint8_t>& image, int width, int height) {
  assert(image.channels == 3 && image.width > 0 && image.height > 0 && width > 0 && height > 0);
  if (image.width == width && image.height == height) return image;
  Image<float> linear = lowered(narrowed(to_linear(image), width), height);
  if (linear.width == width && linear.height == height) return to_srgb(linear);
  const Result<const image_module::Table*> library = image_module_table();
  if (!library) return forward_error(library);
  Image<float> out(width, height, image.channels);
  const image_module::FloatPixels from = pixels_of(linear);
  const image_module::FloatPixels to = pixels_of(out);
  constexpr const char* kThroughThePixels = "catmull-rom";
  image_module::Fault fault;
  if (!(*library)->resize(&from, &to, kThroughThePixels, kThroughThePixels, &fault)) {
    return fail(ErrorKind::kEnvironment, "cannot resize an image: {}", fault.text);
  }
  return to_srgb(out);
}

}  // namespace seedframe
