// The files of an asset's folder, in and out (docs/formats/asset.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "assets/asset_materials.h"
#include "assets/keypoints.h"
#include "base/canonical_json.h"
#include "base/error.h"
#include "mesh/mesh_measure.h"
#include "mesh/mesh_repair.h"

namespace seedframe {

namespace asset_files {
inline constexpr const char* kMesh = "mesh.drc";
inline constexpr const char* kDescription = "asset.json";
inline constexpr const char* kThumbnail = "thumbnail.png";
/// "mesh.drc", "lod1.drc", "lod2.drc", …
std::string level_file(std::size_t level);
}  // namespace asset_files

/// Letters, digits, '_' and '-', 1 to 64 of them: safe as a folder, in YAML and on a command line.
bool is_asset_name(const std::string& name);

/// One stored mesh of an asset. See StoredLevel for pixels, bound_m and error_m.
struct LevelRecord {
  std::string file;
  std::string sha256;  ///< of the file
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  std::uint64_t bytes = 0;
  int position_bits = 0;
  double pixels = 0.0;
  double bound_m = 0.0;
  double error_m = 0.0;

  /// Of the whole stream, connectivity and UVs included, for each of three coordinates a vertex.
  double bits_per_coordinate() const {
    return 8.0 * static_cast<double>(bytes) / (3.0 * static_cast<double>(vertices));
  }
};

/// What asset.json says.
struct AssetDescription {
  std::string name;
  std::string description;
  std::string category;
  double smooth_angle_deg = 0.0;
  std::vector<std::string> slots;
  std::string source;                  ///< the imported file's name
  std::vector<LevelRecord> levels;     ///< at least one; level 0 is the mesh itself
  MeshMeasures measures;               ///< of level 0; its centroid is not stored
  std::size_t self_intersections = 0;  ///< of the mesh before compression
  RepairReport repairs;                ///< written, not read
  /// Where the imported file has the mesh's origin, metres, z up. Written, not read.
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  KeypointSet keypoints;     ///< may have none
  AssetMaterials materials;  ///< of slots; may have none
};

/// The name must be the folder's.
Result<AssetDescription> read_asset_description(const std::filesystem::path& folder);

/// As asset.json holds it.
Json asset_json(const AssetDescription& asset);

/// Puts other keypoints into asset.json and leaves the rest of it as it is.
Status set_keypoints(const std::filesystem::path& folder, const KeypointSet& keypoints);

/// Writes asset.json and the other files of the asset, by their names in the folder; it appears, or
/// is replaced, at once.
Status write_asset(const std::filesystem::path& folder, const AssetDescription& asset,
                   const std::map<std::string, std::string>& files);

/// Removes an asset's folder, or the link to it; its name is gone at once.
Status remove_asset(const std::filesystem::path& folder);

}  // namespace seedframe
