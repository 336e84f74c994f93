// The picture in a frame's folder: image.png, image.jpg, image.webp or image.tif.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/error.h"
#include "image/image.h"
#include "spec/image_encoding.h"

namespace seedframe {

/// Its RGB pixels. kCorrupt error: missing, cut or damaged. kEnvironment error: all but PNG need
/// the image module (image_files/image_module.h).
Result<Image<std::uint8_t>> read_frame_image(const std::filesystem::path& folder,
                                             ImageFormat format);

}  // namespace seedframe
