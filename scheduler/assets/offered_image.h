// An image file that frames of a campaign may hold.
#pragma once

#include <filesystem>

#include "assets/image_check.h"
#include "base/place.h"

namespace seedframe {

struct OfferedImage {
  std::filesystem::path file;
  ImageUse use = ImageUse::kData;
  Place place;  ///< what in the config names it, or may
};

}  // namespace seedframe
