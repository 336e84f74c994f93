// Named meshes on disk: <root>/<name>/mesh.drc and asset.json (docs/formats/asset.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "assets/asset_materials.h"
#include "assets/keypoints.h"
#include "base/allowed_folders.h"
#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

/// A stored version of an asset's mesh. Level 0 is the mesh itself; see StoredLevel.
struct LevelOfDetail {
  std::uint64_t triangles = 0;
  double error_m = 0.0;  ///< from level 0 for the others, from the imported mesh for level 0
  std::string sha256;    ///< of its file
};

/// A level with all that a frame needs of it.
struct LevelMesh {
  Mesh mesh;
  std::string buffer;         ///< mesh_buffer(mesh), as a worker reads it
  std::string buffer_sha256;  ///< the mesh's name in frame specs
};

struct Asset {
  std::string name;
  std::string category;          ///< empty for a distractor
  std::string description;       ///< one line, for people
  std::filesystem::path folder;  ///< that it was read from
  Mesh mesh;
  std::string buffer;                 ///< mesh_buffer(mesh), as a worker reads it
  std::string buffer_sha256;          ///< the mesh's name in frame specs
  std::string mesh_sha256;            ///< of mesh.drc, for provenance
  std::uint64_t bytes = 0;            ///< of mesh.drc
  std::vector<LevelOfDetail> levels;  ///< at least one, finest first
  BoundingBox box;
  double metres_per_uv = 1.0;  ///< see metres_per_uv(mesh); exactly 1 if they were projected
  KeypointSet keypoints;
  AssetMaterials materials;  ///< of slots, their files with the asset's folder; may have none
  LowestPoint lowest;

  /// See lowest_z(mesh, linear), but fast.
  double lowest_z(const Eigen::Matrix3d& linear) const { return lowest.z(linear); }
};

/// The assets of one or more folders; where two have the same name, the earlier folder's is used.
/// Cheap to copy (copies share their cache), safe to use from several threads.
class AssetLibrary {
 public:
  /// A root that is not a folder is an error. Looks for names only; meshes are read by load. Files
  /// of an asset lie in one of the roots or in an allowed folder, also after symbolic links are
  /// followed; folder() and load() refuse an asset with others (kInput). `copies`: a folder that is
  /// nearer than the roots; meshes are kept there by their hashes and read there if they are there.
  static Result<AssetLibrary> open(const std::vector<std::filesystem::path>& roots,
                                   AllowedFolders allowed = {},
                                   const std::filesystem::path& copies = {});

  /// Sorted.
  std::vector<std::string> names() const;

  /// An unknown name is an error with the nearest known one (kInput).
  Result<std::filesystem::path> folder(const std::string& name) const;

  /// Reads, checks and keeps an asset. An unknown name is an error with the nearest known one
  /// (kInput); a file that is not what asset.json says is an error (kCorrupt).
  Result<std::shared_ptr<const Asset>> load(const std::string& name) const;

  /// Reads, checks and keeps levels[level] of an asset, as load does. Level 0 is the asset's own
  /// mesh again. A level that does not exist is an error (kInput).
  Result<std::shared_ptr<const LevelMesh>> load_level(const std::string& name,
                                                      std::size_t level) const;

 private:
  struct State;
  explicit AssetLibrary(std::shared_ptr<State> state);

  std::shared_ptr<State> state_;
};

/// Reads one asset's folder, whatever its library; of its levels only the first.
Result<Asset> read_asset(const std::filesystem::path& folder,
                         const std::filesystem::path& copies = {});

}  // namespace seedframe
