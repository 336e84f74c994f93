// Named meshes on disk: <root>/<name>/mesh.drc and asset.json (docs/formats/asset.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "geometry/mesh.h"

namespace seedframe {

struct Asset {
  std::string name;
  std::string category;     ///< empty for a distractor
  std::string description;  ///< one line, for people
  Mesh mesh;
  std::string buffer;         ///< mesh_buffer(mesh), as a worker reads it
  std::string buffer_sha256;  ///< the mesh's name in frame specs
  std::string mesh_sha256;    ///< of mesh.drc, for provenance
  std::uint64_t bytes = 0;    ///< of mesh.drc
  BoundingBox box;
  LowestPoint lowest;

  /// See lowest_z(mesh, linear), but fast.
  double lowest_z(const Eigen::Matrix3d& linear) const { return lowest.z(linear); }
};

/// The assets of one or more folders; of two with one name the earlier folder's counts. Cheap to
/// copy (copies share their cache), safe to use from several threads.
class AssetLibrary {
 public:
  /// A root that is not a folder is an error. Looks for names only; meshes are read by load.
  static Result<AssetLibrary> open(const std::vector<std::filesystem::path>& roots);

  /// Sorted.
  std::vector<std::string> names() const;

  /// Reads, checks and keeps an asset. An unknown name is an error with the nearest known one
  /// (kInput); a file that is not what asset.json says is an error (kCorrupt).
  Result<std::shared_ptr<const Asset>> load(const std::string& name) const;

 private:
  struct State;
  explicit AssetLibrary(std::shared_ptr<State> state);

  std::shared_ptr<State> state_;
};

/// Reads one asset's folder, whatever its library.
Result<Asset> read_asset(const std::filesystem::path& folder);

struct AssetImport {
  std::filesystem::path file;  ///< an OBJ file
  std::filesystem::path root;  ///< made if it does not exist
  std::string name;            ///< of the new folder: letters, digits, '_' and '-'
  std::string category;        ///< empty for a distractor
  std::string description;
  double scale = 1.0;              ///< metres per unit of the file
  double smooth_angle_deg = 30.0;  ///< 0 to 180
  bool replace = false;            ///< an existing asset of that name is an error otherwise
};

/// Reads, checks, compresses and writes an asset; it appears whole or not at all.
Status import_asset(const AssetImport& request);

}  // namespace seedframe
