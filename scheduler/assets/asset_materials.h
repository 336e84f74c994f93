// What an asset's slots look like by themselves: the materials of the file that it was imported
// from.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "mesh_files/file_material.h"
#include "spec/frame_spec.h"

namespace seedframe {

struct AssetMaterial {
  MaterialSpec spec;                         ///< its textures are the SHA-256 of their files
  std::map<std::string, std::string> files;  ///< of these textures, in the asset's folder
};
using AssetMaterials = std::map<std::string, AssetMaterial>;  ///< by slot

struct MadeMaterials {
  AssetMaterials materials;
  std::map<std::string, std::string> files;  ///< name in the asset's folder, bytes
  std::vector<std::string> dropped;          ///< a sentence each
};

/// For those of the slots that have a material in the file. Images are decoded; what Blender could
/// not render is dropped. A channel of an image becomes an image of its own, in grey.
MadeMaterials make_materials(const std::map<std::string, FileMaterial>& materials,
                             const std::vector<std::string>& slots);

Json to_json(const AssetMaterials& materials);
/// kCorrupt errors begin with `what`.
Result<AssetMaterials> materials_from_json(const Json& json, const std::string& what);

}  // namespace seedframe
