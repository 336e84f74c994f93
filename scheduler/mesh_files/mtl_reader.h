// The materials of Wavefront OBJ files.
#pragma once

#include <map>
#include <string>

#include "mesh_files/beside_files.h"
#include "mesh_files/file_material.h"
#include "mesh_files/mesh_builder.h"

namespace seedframe {

/// Reads a .mtl file that an OBJ file names. Colours are taken for linear; of Ns, roughness is made
/// as Blender makes it. Nothing here is an error: `builder` is told what is dropped and what is not
/// kept.
std::map<std::string, FileMaterial> read_mtl(const std::string& name, BesideFiles& files,
                                             MeshBuilder& builder);

}  // namespace seedframe
