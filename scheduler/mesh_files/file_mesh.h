// A mesh as its file has it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh.h"

namespace seedframe {

struct FileMesh {
  Mesh mesh;                                     ///< all but its positions
  std::vector<std::array<double, 3>> positions;  ///< in the file's unit and axes
  /// How far apart the file's own numbers are at its largest coordinate, where it stores 32-bit
  /// floats; 0 where it stores more digits.
  double spacing = 0.0;
  std::vector<std::string> dropped;   ///< optional parts that were wrong: a sentence each
  std::vector<std::string> not_kept;  ///< what an asset has no place for: a few words each
};

}  // namespace seedframe
