// The materials of glTF 2.0 files.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "mesh_files/file_material.h"
#include "mesh_files/gltf_file.h"
#include "mesh_files/mesh_builder.h"

namespace seedframe {

/// Reads materials and the images that they use, each image once. What is not understood is no
/// error: `builder` is told what is dropped and what is not kept.
class GltfMaterials {
 public:
  GltfMaterials(const GltfFile& file, MeshBuilder& builder) : file_(file), builder_(builder) {}

  FileMaterial read(const Json& material);

 private:
  void read_opacity(const Json& material, const Json& pbr, FileMaterial& out);
  void read_extensions(const Json& material, FileMaterial& out);
  /// The image of material[key]; null if it has none.
  std::shared_ptr<const FileImage> image_of(const Json& material, const char* key);
  std::shared_ptr<const FileImage> load(std::uint64_t image);

  const GltfFile& file_;
  MeshBuilder& builder_;
  std::map<std::uint64_t, std::shared_ptr<const FileImage>> images_;
  std::uintmax_t image_bytes_ = 0;
};

}  // namespace seedframe
