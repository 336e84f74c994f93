// Pictures as files, which tell that Seedframe drew them: only such may be replaced unasked.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// Whether a picture could be written there: the name ends in .png or .jpg, and what is there
/// already, if anything, is a picture that Seedframe drew, or may be overwritten. kInput error: why
/// not.
Status check_picture_file(const std::filesystem::path& path, bool overwrite);

/// An RGB image, as a PNG or a JPEG (quality 90) by the name's ending; the same pixels give the
/// same bytes. Errors of check_picture_file, and of the disk.
Status write_picture(const Image<std::uint8_t>& image, const std::filesystem::path& path,
                     bool overwrite);

}  // namespace seedframe
