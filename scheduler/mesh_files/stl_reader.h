// STL files in, binary and text.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "mesh_files/file_mesh.h"

namespace seedframe {

/// Corners at the same place become one vertex. STL has no UVs, no materials and no units: UVs are
/// (0, 0), the one slot is "default", coordinates are taken as they stand. Normals are not read:
/// the order of the corners tells the outside.
Result<FileMesh> read_stl(const std::filesystem::path& path);

}  // namespace seedframe
