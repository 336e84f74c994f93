// Wavefront OBJ files in.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

/// All objects and groups of the file as one mesh: polygons triangulated, a slot for each usemtl
/// name in the order of first use ("default" without any), UV (0, 0) where a corner has
/// none, or the file has none at all.
/// Coordinates are taken as they stand, z up. Materials of .mtl files are not read.
/// smooth_angle_rad is 0.
Result<Mesh> read_obj(const std::filesystem::path& path);

}  // namespace seedframe
