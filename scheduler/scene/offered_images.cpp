#include "scene/offered_images.h"

#include <set>
#include <utility>

namespace seedframe {
namespace {

class Collector {
 public:
  Collector(const MaterialLibrary& library, const AssetLibrary& assets)
      : library_(library), assets_(assets) {}

  void add(const CompiledObject& object) {
    if (object.asset || object.material_for_objects) add(object.materials);
    bool can_be_own = object.materials.can_be_own;
    for (const auto& [slot, materials] : object.slots) {
      add(materials);
      can_be_own = can_be_own || materials.can_be_own;
    }
    if (object.asset && can_be_own) add_own(*object.asset, object.materials.place);
    for (const CompiledObject& child : object.objects) add(child);
  }

  void add(const CompiledMaterials& materials) {
    for (const auto& [name, material] : materials.by_name) {
      if (!material.textures) continue;
      // The material of a texture set stands in no file: then it is the user of it who is named.
      const Place& own = material.textures->place();
      const Place& place = own.file.empty() ? materials.place : own;
      const auto sets = material.textures->possible_values();
      for (const std::string& set : sets.value_or(library_.texture_set_names())) {
        add_set(set, place);
      }
    }
  }

  void add(const CompiledWorld& world) {
    if (!world.hdri) return;
    for (const std::string& name : world.hdri->possible_values().value_or(library_.hdri_names())) {
      const auto found = library_.hdris().find(name);
      if (found == library_.hdris().end()) continue;
      add_file(found->second, ImageUse::kEnvironment, world.hdri->place());
    }
  }

  std::vector<OfferedImage> take() { return std::move(images_); }

 private:
  // Assets that cannot be loaded are somebody else's error.
  void add_own(const NameDraw& asset, const Place& place) {
    for (const std::string& name : asset.possible_values().value_or(assets_.names())) {
      const auto loaded = assets_.load(name);
      if (!loaded) continue;
      for (const auto& [slot, material] : (*loaded)->materials) {
        for (const auto& [role, file] : material.files) {
          add_file(file, role == "color" ? ImageUse::kColor : ImageUse::kData, place);
        }
      }
    }
  }

  void add_set(const std::string& name, const Place& place) {
    const auto found = library_.texture_sets().find(name);
    if (found == library_.texture_sets().end()) return;
    for (const auto& [role, file] : found->second.files) {
      add_file(file, role == "color" ? ImageUse::kColor : ImageUse::kData, place);
    }
  }

  void add_file(const std::filesystem::path& file, ImageUse use, const Place& place) {
    if (seen_.emplace(file, use).second) images_.push_back({file, use, place});
  }

  const MaterialLibrary& library_;
  const AssetLibrary& assets_;
  std::vector<OfferedImage> images_;
  std::set<std::pair<std::filesystem::path, ImageUse>> seen_;
};

}  // namespace

std::vector<OfferedImage> offered_images(const CompiledConfig& config,
                                         const MaterialLibrary& library,
                                         const AssetLibrary& assets) {
  Collector collector(library, assets);
  collector.add(config.world);
  if (config.ground) collector.add(config.ground->materials);
  for (const CompiledObject& object : config.objects) collector.add(object);
  return collector.take();
}

}  // namespace seedframe
