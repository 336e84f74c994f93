// Draws materials and environment maps into a frame, and says which files they are.
#pragma once

#include <memory>
#include <string>

#include "assets/asset_library.h"
#include "base/file_hashes.h"
#include "scene/compiled_config.h"
#include "scene/frame_draft.h"
#include "scene/material_library.h"

namespace seedframe {

/// What gets a material.
struct AssetSlot {
  const Asset& asset;
  const std::string& name;
};

/// A material that is not yet on anything.
struct DrawnMaterial {
  MaterialSpec spec;
  double texture_size_m =
      0.0;  ///< width of an image on the surface; 0: spec.texture_repeat says it
};

/// Puts it on a surface of so many metres per UV unit; returns its index in the spec's materials,
/// where equal ones are one.
int put_on(DrawnMaterial material, double metres_per_uv, FrameDraft& draft);

/// Safe to use from several threads.
class MaterialPicker {
 public:
  explicit MaterialPicker(MaterialLibrary library)
      : library_(std::move(library)), hashes_(std::make_unique<FileHashes>()) {}

  const MaterialLibrary& library() const { return library_; }

  /// Without a slot of an asset the draw cannot be kOwnMaterial.
  DrawnMaterial draw(const CompiledMaterials& materials, const AssetSlot* slot, UsedFiles& used,
                     EvaluationContext& context) const;

  /// SHA-256 of an environment map's file, by its name.
  std::string hdri(const NameDraw& draw, FrameDraft& draft, EvaluationContext& context) const;

 private:
  std::string draw_name_of(const CompiledMaterials& materials, EvaluationContext& context) const;
  /// Plain grey for a slot that has none; an error if no slot of the asset has one.
  MaterialSpec own_material(const AssetSlot& slot, const Place& place, UsedFiles& used,
                            EvaluationContext& context) const;
  void add_textures(const std::string& set, const Place& place, MaterialSpec& material,
                    UsedFiles& used, EvaluationContext& context) const;
  /// The SHA-256 of an image file, which becomes one of those used.
  std::string use(const std::filesystem::path& file, const Place& place, UsedFiles& used,
                  EvaluationContext& context) const;

  MaterialLibrary library_;
  std::unique_ptr<FileHashes> hashes_;
};

}  // namespace seedframe
