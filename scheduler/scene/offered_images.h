// Which image files a config can bring into a frame, and as what.
#pragma once

#include <vector>

#include "assets/asset_library.h"
#include "assets/offered_image.h"
#include "scene/compiled_config.h"

namespace seedframe {

/// Each file once for each use, in the order of the config. Where only a draw tells the name, every
/// possibility is offered.
std::vector<OfferedImage> offered_images(const CompiledConfig& config,
                                         const MaterialLibrary& library,
                                         const AssetLibrary& assets);

}  // namespace seedframe
