#include "page/thumbnail.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <unordered_map>

namespace seedframe {
namespace {

constexpr double kPixelsOfAPage = 75e6;  // at about 0.3 bytes each in WebP, more in base64
constexpr int kLargestThumbnail = 480;
constexpr int kSmallestThumbnail = 96;
constexpr int kLinearSteps = 4096;

const std::array<float, 256>& linear_of_code() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double code = static_cast<double>(i) / 255.0;
      values[i] = static_cast<float>(code <= 0.04045 ? code / 12.92
                                                     : std::pow((code + 0.055) / 1.055, 2.4));
    }
    return values;
  }();
  return table;
}

std::uint8_t code_of_linear(double linear) {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> codes(kLinearSteps + 1);
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const double x = static_cast<double>(i) / kLinearSteps;
      const double code = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
      codes[i] = static_cast<std::uint8_t>(std::lround(255.0 * code));
    }
    return codes;
  }();
  return table[static_cast<std::size_t>(std::lround(std::clamp(linear, 0.0, 1.0) * kLinearSteps))];
}

/// Which source pixels a pixel covers along one axis, and how much of the first and the last.
struct Cover {
  int first = 0;
  int last = 0;
  double of_first = 1.0;
  double of_last = 1.0;

  double weight(int i) const {
    if (i == first) return of_first;
    return i == last ? of_last : 1.0;
  }
};

std::vector<Cover> covers(int from, int to) {
  std::vector<Cover> all(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double begin = static_cast<double>(i) * from / to;
    const double end = static_cast<double>(i + 1) * from / to;
    Cover& cover = all[static_cast<std::size_t>(i)];
    cover.first = std::min(from - 1, static_cast<int>(begin));
    cover.last = std::clamp(static_cast<int>(std::ceil(end)) - 1, cover.first, from - 1);
    cover.of_first = std::min(end, cover.first + 1.0) - begin;
    cover.of_last = cover.last == cover.first ? cover.of_first : end - cover.last;
  }
  return all;
}

}  // namespace

ThumbnailSize thumbnail_size(int width, int height, std::int64_t frames) {
  assert(width > 0 && height > 0);
  const double aspect = static_cast<double>(width) / height;
  const double share = kPixelsOfAPage / static_cast<double>(std::max<std::int64_t>(1, frames));
  const int wanted = std::clamp(static_cast<int>(std::sqrt(share * aspect)), kSmallestThumbnail,
                                kLargestThumbnail);
  // The longer side is held to it, or a tall picture would be far too large.
  const double scale = std::min(1.0, static_cast<double>(wanted) / std::max(width, height));
  const auto side = [scale](int px) {
    return std::max(1, static_cast<int>(std::lround(scale * px)));
  };
  return {side(width), side(height)};
}

Image<std::uint8_t> reduced(const Image<std::uint8_t>& image, ThumbnailSize size) {
  assert(image.channels == 3);
  const std::vector<Cover> across = covers(image.width, size.width);
  const std::vector<Cover> down = covers(image.height, size.height);
  const std::array<float, 256>& linear = linear_of_code();
  Image<std::uint8_t> result(size.width, size.height, 3);
  for (int row = 0; row < size.height; ++row) {
    const Cover& rows = down[static_cast<std::size_t>(row)];
    for (int column = 0; column < size.width; ++column) {
      const Cover& columns = across[static_cast<std::size_t>(column)];
      std::array<double, 3> sum{};
      double weights = 0.0;
      for (int y = rows.first; y <= rows.last; ++y) {
        for (int x = columns.first; x <= columns.last; ++x) {
          const double weight = rows.weight(y) * columns.weight(x);
          const std::uint8_t* pixel = &image.at(y, x);
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += weight * static_cast<double>(linear[pixel[c]]);
          weights += weight;
        }
      }
      for (int c = 0; c < 3; ++c) {
        result.at(row, column, c) = code_of_linear(sum[static_cast<std::size_t>(c)] / weights);
      }
    }
  }
  return result;
}

Image<std::uint8_t> reduced_mask(const Image<std::uint16_t>& instance_ids,
                                 const std::vector<int>& ids, ThumbnailSize size) {
  std::unordered_map<int, std::uint8_t> places;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    places[ids[i]] = static_cast<std::uint8_t>(std::min<std::size_t>(255, i + 1));
  }
  Image<std::uint8_t> mask(size.width, size.height);
  for (int row = 0; row < size.height; ++row) {
    const int y = (2 * row + 1) * instance_ids.height / (2 * size.height);
    for (int column = 0; column < size.width; ++column) {
      const int x = (2 * column + 1) * instance_ids.width / (2 * size.width);
      const auto id = instance_ids.at(y, x);
      if (id == 0) continue;
      const auto found = places.find(id);
      if (found != places.end()) mask.at(row, column) = found->second;
    }
  }
  return mask;
}

PictureSignature signature_of(const Image<std::uint8_t>& image) {
  assert(image.channels == 3);
  constexpr int kParts = 8;
  PictureSignature signature{};
  for (int part = 0; part < kParts * kParts; ++part) {
    const int row = part / kParts;
    const int column = part % kParts;
    const int top = row * image.height / kParts;
    const int bottom = std::max(top + 1, (row + 1) * image.height / kParts);
    const int left = column * image.width / kParts;
    const int right = std::max(left + 1, (column + 1) * image.width / kParts);
    std::array<std::int64_t, 3> sum{};
    std::int64_t count = 0;
    for (int y = top; y < std::min(bottom, image.height); ++y) {
      for (int x = left; x < std::min(right, image.width); ++x) {
        for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += image.at(y, x, c);
        ++count;
      }
    }
    for (std::size_t c = 0; c < 3 && count > 0; ++c) {
      signature[static_cast<std::size_t>(part) * 3 + c] =
          static_cast<std::uint8_t>((sum[c] + count / 2) / count);
    }
  }
  return signature;
}

double mean_luma(const PictureSignature& signature) {
  double sum = 0.0;
  for (std::size_t i = 0; i < signature.size(); i += 3) {
    sum += 0.2126 * signature[i] + 0.7152 * signature[i + 1] + 0.0722 * signature[i + 2];
  }
  return sum / (static_cast<double>(signature.size()) / 3.0);
}

}  // namespace seedframe
