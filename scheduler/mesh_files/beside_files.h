// Files that a mesh file names: images and materials.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/allowed_folders.h"
#include "mesh_files/file_material.h"
#include "mesh_files/mesh_builder.h"

namespace seedframe {

/// Those in the mesh file's folder or below it; nothing else is opened.
class BesideFiles {
 public:
  BesideFiles(const std::filesystem::path& mesh_file, MeshBuilder& builder)
      : folder_(mesh_file.parent_path()), allowed_({folder_}), builder_(builder) {}

  /// Where a path leads elsewhere, as to the disk of whoever wrote it, a file of its name in the
  /// folder is taken.
  std::optional<std::filesystem::path> find(std::string name) const;

  /// Each is read once. Null, and the builder is told, where there is none.
  std::shared_ptr<const FileImage> image(const std::string& name);

 private:
  std::filesystem::path folder_;
  AllowedFolders allowed_;
  MeshBuilder& builder_;
  std::map<std::string, std::shared_ptr<const FileImage>> images_;
  std::uintmax_t image_bytes_ = 0;
};

}  // namespace seedframe
