// Wavefront OBJ files in.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "mesh_files/file_mesh.h"

namespace seedframe {

/// All objects and groups of the file as one mesh: polygons triangulated, a slot for each usemtl
/// name in the order of first use ("default" without any), UV (0, 0) where a corner has none, or
/// names one that is not there. Materials are those of its .mtl files.
Result<FileMesh> read_obj(const std::filesystem::path& path);

}  // namespace seedframe
