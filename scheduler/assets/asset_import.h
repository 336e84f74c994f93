// Mesh files into assets.
#pragma once

#include <filesystem>
#include <functional>
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
  /// Metres per unit of the file; nothing: 1, and what its unit may be is guessed in a warning.
  std::optional<double> scale = {};
  double smooth_angle_deg = 30.0;  ///< 0 to 180
  bool replace = false;            ///< an existing asset of that name is an error otherwise
  std::optional<UpAxis> up = {};   ///< nothing: as usual for the format
  RepairOptions repair = {};
  LevelOptions levels = {};
  bool dry_run = false;                                       ///< everything but writing
  std::function<void(const std::string& step)> on_step = {};  ///< what is begun, if it is set
};

/// What was found, repaired and measured; asset.json holds the same.
struct ImportReport {
  AssetDescription description;
  bool unit_was_guessed = false;      ///< neither the request nor the file says it: metres
  std::vector<std::string> warnings;  ///< a sentence each
  std::vector<std::string> not_kept;  ///< what the file has and an asset has not: a few words each
};

/// Reads, repairs, measures, simplifies, compresses and writes an asset; it appears whole or not at
/// all.
Result<ImportReport> import_asset(const AssetImport& request);

}  // namespace seedframe
