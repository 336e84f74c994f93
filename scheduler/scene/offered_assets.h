// Which assets a config can bring into a frame, and as what.
#pragma once

#include <string>
#include <vector>

#include "assets/asset_library.h"
#include "assets/offered_asset.h"
#include "base/error.h"
#include "scene/compiled_config.h"

namespace seedframe {

/// By name. Of an asset whose name or category only a draw tells, every possibility is offered.
Result<std::vector<OfferedAsset>> offered_assets(const std::vector<CompiledObject>& objects,
                                                 const AssetLibrary& assets,
                                                 const std::vector<std::string>& categories);

}  // namespace seedframe
