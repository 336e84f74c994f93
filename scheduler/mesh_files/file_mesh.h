// A mesh as its file has it.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "mesh_files/file_material.h"

namespace seedframe {

struct FileMesh {
  Mesh mesh;                                     ///< all but its positions
  std::vector<std::array<double, 3>> positions;  ///< in the file's unit and axes
  /// How far apart the file's own numbers are at its largest coordinate, where it stores 32-bit
  /// floats; 0 where it stores more digits.
  double spacing = 0.0;
  std::map<std::string, FileMaterial> materials;  ///< by the name of the slot; there may be none
  std::vector<std::string> dropped;   ///< optional parts that were wrong: a sentence each
  std::vector<std::string> not_kept;  ///< what an asset has no place for: a few words each
};

}  // namespace seedframe
