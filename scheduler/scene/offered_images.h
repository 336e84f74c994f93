// Which image files a config can bring into a frame, and as what.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assets/image_check.h"
#include "scene/compiled_config.h"

namespace seedframe {

struct OfferedImage {
  std::filesystem::path file;
  ImageUse use = ImageUse::kData;
  Place place;  ///< what in the config names it, or may
};

/// Each file once for each use, in the order of the config. Where only a draw tells the name, every
/// possibility is offered.
std::vector<OfferedImage> offered_images(const CompiledConfig& config,
                                         const MaterialLibrary& library);

}  // namespace seedframe
