#include "scene/offered_images.h"

#include <set>
#include <utility>

namespace seedframe {
namespace {

class Collector {
 public:
  explicit Collector(const MaterialLibrary& library) : library_(library) {}

  void add(const CompiledObject& object) {
    if (object.asset) add(object.materials);
    for (const auto& [slot, materials] : object.slots) add(materials);
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
  std::vector<OfferedImage> images_;
  std::set<std::pair<std::filesystem::path, ImageUse>> seen_;
};

}  // namespace

std::vector<OfferedImage> offered_images(const CompiledConfig& config,
                                         const MaterialLibrary& library) {
  Collector collector(library);
  collector.add(config.world);
  if (config.ground) collector.add(config.ground->materials);
  for (const CompiledObject& object : config.objects) collector.add(object);
  return collector.take();
}

}  // namespace seedframe
