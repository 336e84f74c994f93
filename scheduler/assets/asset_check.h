// Whether stored assets are what they say.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace seedframe {

struct AssetCheck {
  /// Measure the distance of each coarser level from level 0 with a bounded error, seconds a level;
  /// otherwise look at the vertices, the middles of edges and the centres of both meshes.
  bool thorough = false;
};

/// What is wrong with an asset, a sentence each that names file and key; empty if nothing is. Reads
/// and hashes every file, decodes it, measures the meshes again and compares with asset.json.
std::vector<std::string> check_asset(const std::filesystem::path& folder, const AssetCheck& check);

}  // namespace seedframe
