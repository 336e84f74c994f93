// One stored mesh of an asset, in.
#pragma once

#include <filesystem>

#include "assets/asset_files.h"
#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

/// The mesh of description.levels[level], with the asset's slots and smoothing. A file that is not
/// what the description says is an error (kCorrupt). `copies`: see AssetLibrary::open.
Result<Mesh> read_level_mesh(const std::filesystem::path& folder,
                             const AssetDescription& description, std::size_t level,
                             const std::filesystem::path& copies = {});

}  // namespace seedframe
