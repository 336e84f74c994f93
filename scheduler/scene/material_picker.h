// Draws materials into a frame spec, and knows the files that it names.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "scene/compiled_config.h"
#include "scene/material_library.h"

namespace seedframe {

class MaterialPicker {
 public:
  explicit MaterialPicker(MaterialLibrary library) : library_(std::move(library)) {}

  const MaterialLibrary& library() const { return library_; }

  /// Draws a material; returns its index in spec.materials, where equal ones are one.
  int add(const CompiledMaterials& materials, FrameSpec& spec, EvaluationContext& context);

  /// SHA-256 of an environment map's file, by its name.
  std::string hdri(const NameDraw& draw, EvaluationContext& context);

  /// Image files of all frames so far, by SHA-256.
  const std::map<std::string, std::filesystem::path>& files() const { return files_; }

 private:
  std::string draw_name_of(const CompiledMaterials& materials, EvaluationContext& context) const;
  void add_textures(const std::string& set, const Place& place, MaterialSpec& material,
                    EvaluationContext& context);
  std::string hash_of(const std::filesystem::path& file, const Place& place,
                      EvaluationContext& context);

  MaterialLibrary library_;
  std::map<std::filesystem::path, std::string> hashes_;
  std::map<std::string, std::filesystem::path> files_;
};

}  // namespace seedframe
