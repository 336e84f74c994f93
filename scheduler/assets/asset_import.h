// Mesh files into assets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "assets/asset_files.h"
#include "assets/asset_levels.h"
#include "base/error.h"
#include "mesh/mesh_measure.h"
#include "mesh/mesh_repair.h"
#include "mesh_files/mesh_file.h"

namespace seedframe {

struct AssetImport {
  std::filesystem::path file;  ///< of a format that read_mesh_file knows
  std::filesystem::path root;  ///< made if it does not exist
  std::string name;            ///< of the new folder: letters, digits, '_' and '-'
  std::string category;        ///< empty for a distractor
  std::string description;
  double scale = 1.0;              ///< metres per unit of the file
  double smooth_angle_deg = 30.0;  ///< 0 to 180
  bool replace = false;            ///< an existing asset of that name is an error otherwise
  std::optional<UpAxis> up = {};   ///< nothing: as usual for the format
  RepairOptions repair = {};
  LevelOptions levels = {};
  bool dry_run = false;  ///< everything but writing
};

/// What was found, repaired and measured; asset.json holds the same.
struct ImportReport {
  AssetDescription description;
  std::vector<std::string> warnings;  ///< a sentence each
};

/// Reads, repairs, measures, simplifies, compresses and writes an asset; it appears whole or not at
/// all.
Result<ImportReport> import_asset(const AssetImport& request);

}  // namespace seedframe
