#include "scene/section_compiler.h"

#include <algorithm>

namespace seedframe {

CompiledMaterial SectionCompiler::material(const MaterialConfig& config,
                                           const MaterialLibrary& library) const {
  const SectionCompiler inner(scope_, section_ + "." + config.name, level_, errors_);
  CompiledMaterial material;
  material.place = config.place;
  material.base_color = inner.color(config.base_color, "base_color");
  material.metallic = inner.number(config.metallic, "metallic");
  material.roughness = inner.number(config.roughness, "roughness");
  material.specular = inner.number(config.specular, "specular");
  material.transmission = inner.number(config.transmission, "transmission");
  material.ior = inner.number(config.ior, "ior");
  material.clearcoat = inner.number(config.clearcoat, "clearcoat");
  material.texture_repeat = inner.number(config.texture_repeat, "texture_repeat");
  if (config.texture_size_m) {
    material.texture_size_m = inner.number(*config.texture_size_m, "texture_size_m");
  }
  if (config.textures) {
    material.textures = inner.text(*config.textures, "textures");
    refuse_unknown(*material.textures, library.texture_sets(), library,
                   &MaterialLibrary::no_texture_set);
  }
  return material;
}

CompiledMaterials SectionCompiler::materials(const MaterialSource& source,
                                             const MaterialLibrary& library, const std::string& key,
                                             bool has_asset) const {
  CompiledMaterials result;
  result.key = section_ + "." + key;
  std::vector<std::string> wanted;
  if (const auto* share = std::get_if<MaterialShareConfig>(&source)) {
    result.place = share->place;
    CompiledShare compiled = compile_share(*share, library, result.key);
    wanted = compiled.realistic;
    wanted.insert(wanted.end(), compiled.parametric.begin(), compiled.parametric.end());
    result.choice = std::move(compiled);
  } else {
    const NameDraw draw =
        NameDraw::compile(std::get<NameSource>(source), scope_, result.key, level_, errors_);
    result.place = draw.place();
    const auto possible = draw.possible_values();
    wanted = possible.value_or(library.material_names());
    refuse_unknown(draw, library.materials(), library, &MaterialLibrary::no_material,
                   has_asset ? kOwnMaterial : std::string_view());
    const bool can_be_own =
        !possible || std::find(possible->begin(), possible->end(), kOwnMaterial) != possible->end();
    result.can_be_own =
        has_asset && can_be_own && !library.materials().contains(std::string(kOwnMaterial));
    result.choice = draw;
  }
  const SectionCompiler inner(scope_, result.key, level_, errors_);
  for (const std::string& name : wanted) {
    const auto found = library.materials().find(name);
    if (found != library.materials().end() && !result.by_name.contains(name)) {
      result.by_name.emplace(name, inner.material(found->second, library));
    }
  }
  return result;
}

std::optional<CompiledGrid> SectionCompiler::grid(const std::optional<GridConfig>& config) const {
  if (!config) return std::nullopt;
  return CompiledGrid{
      config->place,
      {number(config->counts[0], "grid.counts[0]"), number(config->counts[1], "grid.counts[1]"),
       number(config->counts[2], "grid.counts[2]")},
      vector(config->spacing_m, "grid.spacing_m")};
}

CompiledShare SectionCompiler::compile_share(const MaterialShareConfig& config,
                                             const MaterialLibrary& library,
                                             const std::string& key) const {
  CompiledShare share{NumberDraw::compile(config.realistic_share, scope_, key + ".realistic_share",
                                          level_, errors_),
                      PhiloxStream(scope_.seed, key),
                      level_,
                      {},
                      {}};
  for (const auto& [name, material] : library.materials()) {
    if (name == "default") continue;
    (material.textures ? share.realistic : share.parametric).push_back(name);
  }
  if (config.realistic) share.realistic = *config.realistic;
  if (config.parametric) share.parametric = *config.parametric;
  for (const std::vector<std::string>* names : {&share.realistic, &share.parametric}) {
    for (const std::string& name : *names) {
      if (library.materials().contains(name)) continue;
      errors_.add(config.place, library.no_material(name));
    }
  }
  return share;
}

}  // namespace seedframe
