#include "image/pixel_hash.h"

#include <bit>
#include <cmath>
#include <limits>

#include "base/sha256.h"

namespace seedframe {
namespace {

static_assert(std::endian::native == std::endian::little,
              "values are hashed as they lie in memory");

template <class T>
void add_header(Sha256& hash, const Image<T>& image, std::string_view type,
                std::string_view channels) {
  hash.update(
      fmt::format("seedframe-pixels-1\n{} {} {} {}\n", image.width, image.height, type, channels));
}

template <class T>
std::string hash_of_integers(const Image<T>& image, std::string_view type,
                             std::string_view channels) {
  Sha256 hash;
  add_header(hash, image, type, channels);
  return hash.update(image.values.data(), image.values.size() * sizeof(T)).hex();
}

}  // namespace

std::string pixel_hash(const Image<float>& image, std::string_view type,
                       std::string_view channels) {
  Sha256 hash;
  add_header(hash, image, type, channels);
  // A NaN's sign and payload depend on the CPU that made it, so they must not reach the hash.
  const auto row_values =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  std::vector<float> row(row_values);
  for (int y = 0; y < image.height; ++y) {
    const float* source = image.values.data() + static_cast<std::size_t>(y) * row_values;
    for (std::size_t i = 0; i < row_values; ++i) {
      row[i] = std::isnan(source[i]) ? std::numeric_limits<float>::quiet_NaN() : source[i];
    }
    hash.update(row.data(), row_values * sizeof(float));
  }
  return hash.hex();
}

std::string pixel_hash(const Image<std::uint8_t>& image, std::string_view channels) {
  return hash_of_integers(image, "uint8", channels);
}

std::string pixel_hash(const Image<std::uint16_t>& image, std::string_view channels) {
  return hash_of_integers(image, "uint16", channels);
}

}  // namespace seedframe
