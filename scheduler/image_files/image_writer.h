// Pictures as files: PNG, JPEG, WebP, TIFF. The same pixels give the same bytes (with the same
// libraries): no dates, no names of programs.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"
#include "image/image.h"
#include "spec/image_encoding.h"

namespace seedframe {

/// The bytes of a file with an 8-bit RGB image in sRGB; JPEG keeps colour at full resolution. PNG
/// is written by encode_png, the others by the image module. kInput error: an image that the format
/// cannot hold (sides up to 65,500 in JPEG, 16,383 in WebP). kEnvironment error: see
/// image_module.h.
Result<std::string> encode_image(const Image<std::uint8_t>& image, const ImageEncoding& encoding);

/// Whether images can be written so on this machine: opens the image module if it is needed.
Status check_encoding(const ImageEncoding& encoding);

}  // namespace seedframe
