// Mesh files of any format that can be imported.
#pragma once

#include <filesystem>
#include <optional>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

enum class UpAxis { kY, kZ };

/// An .obj, .ply, .stl, .off, .gltf or .glb file as its reader gives it, turned so that z points
/// up: y is taken to point up in glTF files, z in all others, unless `up` says otherwise. May hold
/// stray vertices and triangles without area; smooth_angle_rad is 0. Errors are kInput.
Result<Mesh> read_mesh_file(const std::filesystem::path& path,
                            std::optional<UpAxis> up = std::nullopt);

}  // namespace seedframe
