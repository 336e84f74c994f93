// OFF files in (text).
#pragma once

#include <filesystem>

#include "base/error.h"
#include "mesh_files/file_mesh.h"

namespace seedframe {

/// Headers OFF, COFF, NOFF, CNOFF, STOFF and the like; of what stands behind a vertex' position
/// only UVs (ST) are taken, colours of faces are not. The one slot is "default", coordinates are
/// taken as they stand. Binary OFF and other dimensions than three are refused.
Result<FileMesh> read_off(const std::filesystem::path& path);

}  // namespace seedframe
