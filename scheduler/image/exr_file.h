// Single-layer float EXR files for depth and normals: what users load without knowing Blender's
// layers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// Writes 32-bit float channels (names such as {"Z"} or {"X","Y","Z"}), ZIP-compressed, without any
/// date or host in the header. Does not force the file to the disk.
Status write_exr(const std::filesystem::path& path, const Image<float>& image,
                 const std::vector<std::string>& channels);

/// One float channel of what write_exr wrote; a kCorrupt error says what is wrong with the file.
Result<Image<float>> read_exr_channel(const std::filesystem::path& path,
                                      const std::string& channel);

}  // namespace seedframe
