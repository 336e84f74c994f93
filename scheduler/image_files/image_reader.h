// Whole images out of the bytes of a file: PNG, JPEG, TIFF, EXR, HDR, WebP, TGA, BMP. The reader is
// chosen by the caller, never by what the bytes look like. Values are as stored: no colour space is
// applied, alpha is not multiplied in.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "image/image.h"
#include "image_files/image_kind.h"

namespace seedframe {

enum class StoredValue { kUint8, kUint16, kHalf, kFloat };

/// What a file says of itself.
struct ImageHeader {
  int width = 0;
  int height = 0;
  StoredValue stored = StoredValue::kUint8;
  std::vector<std::string> channels;  ///< names, as "R", "Y", "layer.R"
  bool has_more_images = false;       ///< pages or parts besides this one

  bool is_float() const { return stored == StoredValue::kHalf || stored == StoredValue::kFloat; }
};

/// Larger ones are refused before their pixels are decoded.
struct ImageLimits {
  int side_px = 65'536;
  std::int64_t pixels = 1 << 28;  ///< 16,384 × 16,384
  std::int64_t values = 1 << 30;  ///< pixels times channels
};

/// Called with the header, and then with rows from top to bottom, until one is an error. Integers
/// of 16 bits come as floats from 0 to 1.
struct ImageVisit {
  std::function<Status(const ImageHeader&)> header = {};
  std::function<Status(int first_row, const Image<std::uint8_t>&)> rows8 = {};  ///< of kUint8
  std::function<Status(int first_row, const Image<float>&)> rows_float = {};    ///< of all others
};

/// Decodes all pixels of the file `what`, a few rows at a time. kInput error, which begins with
/// `what`: not of that kind, cut, damaged, beyond the limits, without pixels, deep, or cropped.
/// kEnvironment error: see image_module.h.
Result<ImageHeader> visit_image(std::string_view bytes, ImageKind kind, const std::string& what,
                                const ImageVisit& visit = {}, const ImageLimits& limits = {});

/// All of the pixels, with all channels, as numbers: integers become 0 … 1.
Result<Image<float>> decode_image(std::string_view bytes, ImageKind kind, const std::string& what,
                                  const ImageLimits& limits = {});
/// Of a file with 8-bit values; kInput error if it has others.
Result<Image<std::uint8_t>> decode_image8(std::string_view bytes, ImageKind kind,
                                          const std::string& what, const ImageLimits& limits = {});

}  // namespace seedframe
