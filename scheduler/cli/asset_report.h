// Assets as text for people and as JSON for programs.
#pragma once

#include <filesystem>
#include <string>

#include "assets/asset_files.h"
#include "assets/asset_import.h"
#include "base/canonical_json.h"

namespace seedframe {

/// What an import found and made, several lines.
std::string import_text(const ImportReport& report, bool written);

/// asset.json with the warnings.
Json import_json(const ImportReport& report);

/// One line of `asset list`, without its end.
std::string list_line(const AssetDescription& asset, const std::filesystem::path& folder);

/// asset.json with the paths of folder and thumbnail; null where there is no thumbnail.
Json list_json(const AssetDescription& asset, const std::filesystem::path& folder);

}  // namespace seedframe
