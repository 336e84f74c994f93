// Pictures as files: PNG, JPEG, WebP, TIFF. The same pixels give the same bytes (with the same
// libraries): no dates, no names of programs.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"
#include "image/image.h"
#include "image_files/image_kind.h"

namespace seedframe {

enum class TiffCompression { kNone, kLzw, kZip };

struct ImageEncoding {
  ImageKind kind = ImageKind::kPng;
  int quality = 95;   ///< of JPEG and WebP, 1 … 100
  int png_level = 6;  ///< of zlib, 0 (none) … 9 (smallest)
  TiffCompression tiff = TiffCompression::kZip;
};

/// The bytes of a file with an 8-bit RGB image in sRGB. JPEG keeps colour at full resolution, WebP
/// at half: its lossless mode is not offered, since OpenImageIO 2.4 loses the last bit in it.
/// kInput error: a kind that is not written (all but the four), or an image that the kind cannot
/// hold (sides up to 65,535 in JPEG, 16,383 in WebP). kEnvironment error: see image_module.h.
Result<std::string> encode_image(const Image<std::uint8_t>& image, const ImageEncoding& encoding);

}  // namespace seedframe
