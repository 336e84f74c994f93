// Puts the objects of a config into the world.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assets/stable_poses.h"
#include "scene/compiled_config.h"
#include "scene/frame_draft.h"
#include "scene/material_picker.h"
#include "scene/placement.h"

namespace seedframe {

/// Safe to use from several threads.
class ObjectPlacer {
 public:
  ObjectPlacer(AssetLibrary assets, std::vector<std::string> categories)
      : assets_(std::move(assets)), categories_(std::move(categories)) {}

  const AssetLibrary& assets() const { return assets_; }

  /// Loads what can be known without a draw; unknown assets, categories and slots are errors.
  void check_names(const CompiledObject& object, Diagnostics& errors) const;

  /// Adds all copies of all objects, parents before what is in them.
  void place_all(const CompiledConfig& config, const MaterialPicker& materials, FrameDraft& draft,
                 EvaluationContext& context) const;

  /// Gives instances with `auto_detail` the coarsest level of their asset whose error is below 1/20
  /// pixel at their nearest point. The camera must be known.
  void choose_levels(FrameDraft& draft, EvaluationContext& context) const;

 private:
  /// What a copy stands in: the world, or a copy of a group.
  struct Parent {
    Affine world_from_parent = Affine::Identity();
    std::uint32_t copy = kNoIndex;          ///< as draws know it
    std::string name;                       ///< "row/1/", before the names of what is in it
    std::optional<DrawnMaterial> material;  ///< for what takes its parent's
    std::vector<Footprint> footprints;
  };
  struct Falling {  // a copy that is piled
    std::size_t placed = 0;
    double order = 0.0;     ///< the less, the earlier
    bool is_first = false;  ///< of its section
  };
  struct Pass {  // what one frame's placing carries around
    const BuiltInSlots& built_in;
    const MaterialPicker& materials;
    FrameDraft& draft;
    EvaluationContext& context;
    std::vector<Falling> falling = {};
  };

  void place(const CompiledObject& object, Parent& parent, Pass& pass) const;
  void place_copy(const CompiledObject& object, const Eigen::Vector3d& offset,
                  const std::string& name, Parent& parent, Pass& pass) const;
  /// Raises what is piled until it lies on what is there already.
  static void pile(Pass& pass);
  struct Placement {
    const std::string& name;
    const Affine& world_from_object;
  };
  /// `material`: see slot_materials.
  void place_instance(const CompiledObject& object, const std::shared_ptr<const Asset>& asset,
                      const Placement& placement, std::optional<DrawnMaterial>& material,
                      Pass& pass) const;
  /// The rotation that puts an asset onto one of its stable faces, which is drawn.
  Eigen::Matrix3d stand(const CompiledObject& object, const Asset& asset,
                        const Eigen::Vector3d& scale, EvaluationContext& context) const;
  /// `common`, the material of slots without one of their own, is drawn if a slot needs it and
  /// there is none. `metres_per_uv` is of the copy.
  static std::vector<int> slot_materials(const CompiledObject& object, const Asset& asset,
                                         double metres_per_uv, std::optional<DrawnMaterial>& common,
                                         Pass& pass);
  /// `assets`: those that the object may have, if that is known.
  void check_categories(const CompiledObject& object,
                        const std::optional<std::vector<std::string>>& assets,
                        Diagnostics& errors) const;
  int category_index(const CompiledObject& object, const Asset& asset,
                     EvaluationContext& context) const;
  std::shared_ptr<const Asset> load_asset(const std::string& name, const Place& place,
                                          Pass& pass) const;

  AssetLibrary assets_;
  std::vector<std::string> categories_;
  std::unique_ptr<StablePoses> stable_poses_ = std::make_unique<StablePoses>();
};

}  // namespace seedframe
