// glTF 2.0 files in: .gltf and .glb.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "mesh_files/file_mesh.h"

namespace seedframe {

/// All meshes of the default scene (of the file, if it has no scenes), each where its nodes put it,
/// in metres, **y up as in the file**. A slot for each material; "default" where a primitive has
/// none. The corners of one node that lie at the same place become one vertex. Skins, morph targets
/// and animations are not applied; points and lines are skipped; images are not opened.
Result<FileMesh> read_gltf(const std::filesystem::path& path);

}  // namespace seedframe
