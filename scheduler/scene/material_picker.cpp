#include "scene/material_picker.h"

#include <algorithm>

namespace seedframe {

std::string MaterialPicker::draw_name_of(const CompiledMaterials& materials,
                                         EvaluationContext& context) const {
  if (const auto* name = std::get_if<NameDraw>(&materials.choice)) return name->evaluate(context);
  const auto& choice = std::get<CompiledShare>(materials.choice);
  const double share = within(choice.realistic_share, 0, 1, "realistic_share", context);
  // One uniform decides both the kind and the material: what is left of it within its kind is
  // again uniform.
  const double u = choice.stream.uniform(context.position(choice.level));
  const bool realistic = u < share;
  const std::vector<std::string>& names = realistic ? choice.realistic : choice.parametric;
  if (names.empty()) {
    context.report(materials.place, fmt::format("there are no {} materials to choose from",
                                                realistic ? "realistic" : "parametric"));
    return "default";
  }
  const double rest = realistic ? u / share : (u - share) / (1.0 - share);
  const auto index = static_cast<std::size_t>(rest * static_cast<double>(names.size()));
  const std::string& name = names[std::min(index, names.size() - 1)];
  if (context.record != nullptr) {
    context.record->push_back({draw_name(materials.key, context), name});
  }
  return name;
}

namespace {

int index_of(MaterialSpec material, std::vector<MaterialSpec>& known) {
  const auto same = std::find(known.begin(), known.end(), material);
  if (same != known.end()) return static_cast<int>(same - known.begin());
  known.push_back(std::move(material));
  return static_cast<int>(known.size()) - 1;
}

}  // namespace

int put_on(DrawnMaterial material, double metres_per_uv, FrameDraft& draft) {
  if (material.texture_size_m > 0.0) {
    material.spec.texture_repeat = metres_per_uv / material.texture_size_m;
  }
  return index_of(std::move(material.spec), draft.spec.materials);
}

DrawnMaterial MaterialPicker::draw(const CompiledMaterials& materials, const AssetSlot* slot,
                                   UsedFiles& used, EvaluationContext& context) const {
  const std::string name = draw_name_of(materials, context);
  if (slot != nullptr && materials.can_be_own && name == kOwnMaterial) {
    return {own_material(*slot, materials.place, used, context)};
  }
  const auto found = materials.by_name.find(name);
  if (found == materials.by_name.end()) {
    context.report(materials.place, library_.no_material(name));
    return {};
  }
  const CompiledMaterial& source = found->second;
  DrawnMaterial drawn;
  MaterialSpec& material = drawn.spec;
  material.base_color = source.base_color.evaluate(context);
  material.metallic = within(source.metallic, 0, 1, "metallic", context);
  material.roughness = within(source.roughness, 0, 1, "roughness", context);
  material.specular = within(source.specular, 0, 1, "specular", context);
  material.transmission = within(source.transmission, 0, 1, "transmission", context);
  material.ior = within(source.ior, 1, 5, "ior", context);
  material.clearcoat = within(source.clearcoat, 0, 1, "clearcoat", context);
  material.texture_repeat = positive(source.texture_repeat, "texture_repeat", context);
  if (source.texture_size_m) {
    drawn.texture_size_m = positive(*source.texture_size_m, "texture_size_m", context);
  }
  if (source.textures) {
    // The material of a texture set stands in no file: then it is the user of it who is named.
    const Place& named = source.textures->place();
    add_textures(source.textures->evaluate(context), named.file.empty() ? materials.place : named,
                 material, used, context);
  }
  return drawn;
}

MaterialSpec MaterialPicker::own_material(const AssetSlot& slot, const Place& place,
                                          UsedFiles& used, EvaluationContext& context) const {
  const AssetMaterials& own = slot.asset.materials;
  if (own.empty()) {
    context.report(place, fmt::format("the asset '{}' has no materials of its own: the file that "
                                      "it was imported from has none; name another material",
                                      slot.asset.name));
  }
  MaterialSpec material;
  material.base_color = {0.8, 0.8, 0.8};
  const auto found = own.find(slot.name);
  if (found == own.end()) return material;
  material = found->second.spec;
  for (const auto& [role, file] : found->second.files) {
    if (use(file, place, used, context) == material.textures.at(role)) continue;
    context.report(place, file +
                              " is damaged: asset.json says another SHA-256; import the asset "
                              "again");
  }
  return material;
}

void MaterialPicker::add_textures(const std::string& set, const Place& place,
                                  MaterialSpec& material, UsedFiles& used,
                                  EvaluationContext& context) const {
  const auto found = library_.texture_sets().find(set);
  if (found == library_.texture_sets().end()) {
    context.report(place, library_.no_texture_set(set));
    return;
  }
  for (const auto& [role, file] : found->second.files) {
    material.textures[role] = use(file, place, used, context);
  }
}

std::string MaterialPicker::hdri(const NameDraw& draw, FrameDraft& draft,
                                 EvaluationContext& context) const {
  const std::string name = draw.evaluate(context);
  const auto found = library_.hdris().find(name);
  if (found != library_.hdris().end()) {
    return use(found->second, draw.place(), draft.used, context);
  }
  context.report(draw.place(), library_.no_hdri(name));
  return "";
}

std::string MaterialPicker::use(const std::filesystem::path& file, const Place& place,
                                UsedFiles& used, EvaluationContext& context) const {
  Result<std::shared_ptr<const HashedFile>> hashed = hashes_->of(file, library_.allowed());
  if (!hashed) {
    context.report(place, hashed.error().message);
    return "";
  }
  std::string sha256 = (*hashed)->sha256;
  used.images.try_emplace((*hashed)->sha256, std::move(*hashed));
  return sha256;
}

}  // namespace seedframe
