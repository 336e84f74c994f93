// The text at the head of a Radiance file (.hdr), of which readers take quite different views.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace seedframe {

/// What every reader understands alike: lines that end with LF, FORMAT=32-bit_rle_rgbe, an empty
/// line, and rows from top to bottom, pixels from left to right (-Y <height> +X <width>). kInput
/// error, which begins with `what`, for anything else. EXPOSURE is ignored, as by Blender.
Status check_radiance_header(std::string_view bytes, const std::string& what);

}  // namespace seedframe
