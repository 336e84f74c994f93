// An asset that frames of a campaign may hold.
#pragma once

#include <memory>
#include <set>
#include <string>

#include "assets/asset_library.h"

namespace seedframe {

struct OfferedAsset {
  std::shared_ptr<const Asset> asset;
  std::set<std::string> categories;  ///< that its instances may have; none: distractors only
};

}  // namespace seedframe
