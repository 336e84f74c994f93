#include "preview/linear_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/files.h"
#include "image/png_file.h"
#include "image_files/image_kind.h"
#include "image_files/image_reader.h"

namespace seedframe {
namespace {

float linear_of(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

const std::array<float, 256>& light_by_code() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light{};
    for (std::size_t code = 0; code < light.size(); ++code) {
      light[code] = linear_of(static_cast<float>(code) / 255.0F);
    }
    return light;
  }();
  return table;
}

/// Takes rows as they are decoded, and keeps of them what is wanted.
class Reduction {
 public:
  Reduction(int most_px, bool is_linear) : most_px_(most_px), is_linear_(is_linear) {}

  Status begin(const ImageHeader& header) {
    const int factor = (std::max(header.width, header.height) + most_px_ - 1) / most_px_;
    from_width_ = header.width;
    from_height_ = header.height;
    sums_ = Image<float>((header.width + factor - 1) / factor,
                         (header.height + factor - 1) / factor, 3);
    counts_ = Image<int>(sums_.width, sums_.height);
    const auto channel = [&](const char* name) {
      const auto found = std::find(header.channels.begin(), header.channels.end(), name);
      return found == header.channels.end() ? 0 : static_cast<int>(found - header.channels.begin());
    };
    channels_ = {channel("R"), channel("G"), channel("B")};
    return {};
  }

  Status add(int first_row, const Image<std::uint8_t>& rows) {
    return add_rows(first_row, rows, [](std::uint8_t code) { return light_by_code()[code]; });
  }
  Status add(int first_row, const Image<float>& rows) {
    return add_rows(first_row, rows, [this](float value) {
      if (!std::isfinite(value) || value <= 0.0F) return 0.0F;
      return is_linear_ ? value : linear_of(value);
    });
  }

  Image<float> end() {
    auto sum = sums_.values.begin();
    for (const int count : counts_.values) {
      for (int c = 0; c < 3; ++c, ++sum) *sum /= static_cast<float>(std::max(1, count));
    }
    return std::move(sums_);
  }

 private:
  template <class T, class Light>
  Status add_rows(int first_row, const Image<T>& rows, const Light& light) {
    for (int row = 0; row < rows.height; ++row) {
      const auto to_row =
          static_cast<int>(std::int64_t{first_row + row} * sums_.height / from_height_);
      for (int column = 0; column < rows.width; ++column) {
        const auto to_column = static_cast<int>(std::int64_t{column} * sums_.width / from_width_);
        float* sum = &sums_.at(to_row, to_column);
        const T* value = &rows.at(row, column);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += light(value[channels_[c]]);
        ++counts_.at(to_row, to_column);
      }
    }
    return {};
  }

  int most_px_;
  bool is_linear_;
  int from_width_ = 1, from_height_ = 1;
  std::array<int, 3> channels_{};
  Image<float> sums_;
  Image<int> counts_;
};

}  // namespace

Result<Image<float>> read_linear_image(const std::filesystem::path& file, int most_px) {
  const std::optional<ImageKind> kind = image_kind_of(file);
  if (!kind) {
    return fail(ErrorKind::kInput, "{} is no image: files are {}", file.string(), image_endings());
  }
  const Result<std::string> bytes = read_file(file);
  if (!bytes) return forward_error(bytes);
  // Most are plain PNGs, which need no library that takes long to load.
  if (*kind == ImageKind::kPng) {
    const Result<Image<std::uint8_t>> plain = decode_png8(*bytes, file.string());
    if (plain && (plain->channels == 1 || plain->channels == 3)) {
      Reduction reduction(most_px, false);
      const std::vector<std::string> names = plain->channels == 1
                                                 ? std::vector<std::string>{"Y"}
                                                 : std::vector<std::string>{"R", "G", "B"};
      if (Status begun = reduction.begin({.width = plain->width,
                                          .height = plain->height,
                                          .stored = StoredValue::kUint8,
                                          .channels = names});
          !begun) {
        return forward_error(begun);
      }
      if (Status added = reduction.add(0, *plain); !added) return forward_error(added);
      return reduction.end();
    }
  }
  Reduction reduction(most_px, *kind == ImageKind::kExr || *kind == ImageKind::kHdr);
  ImageVisit visit;
  visit.header = [&](const ImageHeader& header) { return reduction.begin(header); };
  visit.rows8 = [&](int first, const Image<std::uint8_t>& rows) {
    return reduction.add(first, rows);
  };
  visit.rows_float = [&](int first, const Image<float>& rows) {
    return reduction.add(first, rows);
  };
  const Result<ImageHeader> header = visit_image(*bytes, *kind, file.string(), visit);
  if (!header) return forward_error(header);
  return reduction.end();
}

std::uint8_t srgb_code(float light) {
  constexpr std::size_t kSteps = 1U << 14U;  // in the dark a fifth of a code
  static const std::vector<std::uint8_t> code_by_step = [] {
    std::vector<std::uint8_t> codes(kSteps + 1);
    for (std::size_t step = 0; step <= kSteps; ++step) {
      const double share = std::min(1.0, (static_cast<double>(step) + 0.5) / kSteps);
      const double display =
          share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1.0 / 2.4) - 0.055;
      codes[step] = static_cast<std::uint8_t>(std::lround(255.0 * display));
    }
    return codes;
  }();
  return code_by_step[static_cast<std::size_t>(std::clamp(light, 0.0F, 1.0F) * kSteps)];
}

const std::array<float, 256>& srgb_lights() { return light_by_code(); }

}  // namespace seedframe
