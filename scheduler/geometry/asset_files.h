// The two files of an asset's folder, in and out (docs/formats/asset.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "base/files.h"
#include "base/sha256.h"
#include "geometry/asset_library.h"

namespace seedframe {

namespace asset_files {
inline constexpr const char* kMesh = "mesh.drc";
inline constexpr const char* kDescription = "asset.json";
}  // namespace asset_files

/// Letters, digits, '_' and '-', 1 to 64 of them: safe as a folder, in YAML and on a command line.
bool is_asset_name(const std::string& name);

/// The parts of asset.json that reading depends on; sizes are for people.
struct AssetDescription {
  std::string name;
  std::string description;
  std::string category;
  std::uint64_t triangles = 0;
  double smooth_angle_deg = 0.0;
  std::vector<std::string> slots;
  std::string mesh_sha256;
};

/// The name must be the folder's.
Result<AssetDescription> read_asset_description(const std::filesystem::path& folder);

/// Compresses the mesh and writes both files; what they say of the mesh holds for the compressed
/// one.
Status write_asset(const std::filesystem::path& folder, const Mesh& mesh,
                   const AssetImport& request);

}  // namespace seedframe
