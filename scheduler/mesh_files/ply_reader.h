// PLY files in, text and binary.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "mesh_files/file_mesh.h"

namespace seedframe {

/// The elements "vertex" (x, y, z; s and t, u and v or texture_u and texture_v) and "face"
/// (vertex_indices or vertex_index; texcoord, two numbers a corner; material_index or texnumber,
/// which become the slots "material0", "material1", …); others are skipped. Coordinates are taken
/// as they stand.
Result<FileMesh> read_ply(const std::filesystem::path& path);

}  // namespace seedframe
