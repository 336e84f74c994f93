// The models of a BOP dataset: object ids, PLY files in millimetres, models_info.json.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "assets/offered_asset.h"
#include "base/error.h"
#include "export/format.h"

namespace seedframe {

inline constexpr double kMillimetresPerMetre = 1000.0;

/// 1, 2, … for the assets by name.
std::map<std::string, int> bop_object_ids(const std::vector<OfferedAsset>& assets);

/// Adds models/ and models.json.
void add_bop_models(const std::vector<OfferedAsset>& assets, CommonPart& common);

}  // namespace seedframe
