// Mesh files of any format that can be imported.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/mesh.h"
#include "mesh_files/file_material.h"

namespace seedframe {

enum class UpAxis { kY, kZ };

struct MeshFileOptions {
  std::optional<UpAxis> up = {};  ///< nothing: y in glTF files, z in all others
  double scale = 1.0;             ///< metres per unit of the file
  /// Rounding to 32-bit floats may move a vertex by this share of the mesh's longest side; if it
  /// would move one farther, the mesh is first moved to the origin.
  double most_rounding = 5e-6;
};

struct MeshFile {
  /// Metres, z up. May hold stray vertices, triangles without area and slots without triangles;
  /// smooth_angle_rad is 0.
  Mesh mesh;
  /// Where the file has what is the mesh's (0, 0, 0), in metres, z up.
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  double rounding_m = 0.0;       ///< vertices are at most so far from where the file has them
  double spacing_m = 0.0;        ///< see FileMesh::spacing
  bool has_unit = false;         ///< the format says what a unit is
  bool has_up = false;           ///< the format says where up is
  bool by_y_up_program = false;  ///< the file says that a program wrote it that has y up
  std::map<std::string, FileMaterial> materials;  ///< see FileMesh::materials
  std::vector<std::string> dropped;               ///< see FileMesh::dropped
  std::vector<std::string> not_kept;              ///< see FileMesh::not_kept
};

/// An .obj, .ply, .stl, .off, .gltf or .glb file. Errors are kInput.
Result<MeshFile> read_mesh_file(const std::filesystem::path& path,
                                const MeshFileOptions& options = {});

}  // namespace seedframe
