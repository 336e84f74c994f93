#include "sensor/camera_sensor.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "base/philox.h"
#include "base/portable_math.h"
#include "image/separable_filter.h"
#include "image_files/image_reader.h"
#include "image_files/image_writer.h"

namespace seedframe {
namespace {

constexpr std::size_t kSensorChannels = 3;

float light_of(double code) {
  const double v = code / 255.0;
  return static_cast<float>(v <= 0.04045 ? v / 12.92 : portable::pow((v + 0.055) / 1.055, 2.4));
}

/// Light to codes and back, without a function that differs from CPU to CPU.
struct CodeTable {
  std::array<float, 256> light{};       ///< of each code
  std::array<float, 255> thresholds{};  ///< between a code and the next

  CodeTable() {
    for (int code = 0; code < 256; ++code) {
      light[static_cast<std::size_t>(code)] = light_of(code);
      if (code < 255) thresholds[static_cast<std::size_t>(code)] = light_of(code + 0.5);
    }
  }
  std::uint8_t code_of(float value) const {
    const auto above = std::upper_bound(thresholds.begin(), thresholds.end(), value);
    return static_cast<std::uint8_t>(above - thresholds.begin());
  }
};

constexpr int kNormalBits = 14;

/// Normal deviates of deviation 1, each as likely: a draw is one of them.
std::vector<float> make_normal_table() {
  constexpr std::size_t kHalf = std::size_t{1} << (kNormalBits - 1);
  std::vector<float> table(2 * kHalf);
  long double x = 0.0L;
  for (std::size_t i = 0; i < kHalf; ++i) {  // outwards from the middle
    const long double tail = 0.5L - (static_cast<long double>(i) + 0.5L) / (2 * kHalf);
    for (int step = 0; step < 6; ++step) {  // Newton's
      const long double density = expl(-0.5L * x * x) * 0.398942280401432677939946L;
      x += (0.5L * erfcl(x * 0.707106781186547524400844L) - tail) / density;
    }
    table[kHalf + i] = static_cast<float>(x);
    table[kHalf - 1 - i] = static_cast<float>(-x);
  }
  return table;
}

const std::vector<float>& normal_table() {
  static const std::vector<float> table = make_normal_table();
  return table;
}

using LightPlanes = std::array<Plane<float>, kSensorChannels>;

std::vector<float> gaussian(double deviation) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3.0 * deviation)));
  std::vector<double> weights;
  weights.reserve(2 * static_cast<std::size_t>(radius) + 1);
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(portable::exp(-0.5 * i * i / (deviation * deviation)));
    sum += weights.back();
  }
  std::vector<float> kernel;
  kernel.reserve(weights.size());
  for (const double weight : weights) kernel.push_back(static_cast<float>(weight / sum));
  return kernel;
}

void blur(LightPlanes& planes, double deviation) {
  const std::vector<float> kernel = gaussian(deviation);
  const int radius = static_cast<int>(kernel.size() / 2);
  for (Plane<float>& plane : planes) {
    plane = filtered_columns(filtered_rows(with_border(plane, radius), kernel), kernel);
  }
}

/// Of one pixel, all channels of it: any order of pixels gives the same noise.
void add_noise(LightPlanes& planes, const SensorSettings& sensor) {
  const PhiloxStream stream(sensor.seed, "sensor.noise");
  const std::vector<float>& normal = normal_table();
  const auto full = static_cast<float>(sensor.full_well);
  const auto read = static_cast<float>(sensor.read_noise);
  const Eigen::Index rows = planes[0].rows();
  const Eigen::Index columns = planes[0].cols();
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index column = 0; column < columns; ++column) {
      std::uint64_t bits = stream.bits(
          {static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column), kNoIndex, 0});
      for (Plane<float>& plane : planes) {
        float& light = plane(row, column);
        const float electrons = std::max(0.0F, light * full);
        const float deviate = normal[bits & ((std::uint64_t{1} << kNormalBits) - 1)];
        bits >>= 16;
        light += deviate * std::sqrt(electrons + read * read) / full;
      }
    }
  }
}

Result<Image<std::uint8_t>> as_jpeg(const Image<std::uint8_t>& picture, int quality) {
  const auto bytes = encode_image(picture, {.format = ImageFormat::kJpeg, .quality = quality});
  if (!bytes) return forward_error(bytes);
  return decode_image8(*bytes, ImageKind::kJpeg, "the camera's JPEG");
}

}  // namespace

Result<Image<std::uint8_t>> through_sensor(const Image<std::uint8_t>& picture,
                                           const SensorSettings& sensor) {
  assert(picture.channels == static_cast<int>(kSensorChannels));
  static const CodeTable table;
  LightPlanes planes;
  const auto exposure = static_cast<float>(portable::pow(2.0, sensor.exposure_stops));
  for (std::size_t channel = 0; channel < kSensorChannels; ++channel) {
    planes[channel].resize(picture.height, picture.width);
    float* light = planes[channel].data();
    for (std::size_t i = channel; i < picture.values.size(); i += kSensorChannels) {
      *light++ = table.light[picture.values[i]];
    }
  }
  if (sensor.blur_px > 0.0) blur(planes, sensor.blur_px);
  for (Plane<float>& plane : planes) plane *= exposure;
  if (sensor.full_well > 0.0) add_noise(planes, sensor);
  Image<std::uint8_t> taken(picture.width, picture.height, picture.channels);
  for (std::size_t channel = 0; channel < kSensorChannels; ++channel) {
    const auto gain = static_cast<float>(sensor.white_balance[channel]);
    const float* light = planes[channel].data();
    for (std::size_t i = channel; i < taken.values.size(); i += kSensorChannels) {
      taken.values[i] = table.code_of(*light++ * gain);
    }
  }
  return sensor.jpeg_quality > 0 ? as_jpeg(taken, sensor.jpeg_quality) : taken;
}

}  // namespace seedframe
