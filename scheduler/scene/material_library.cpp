#include "scene/material_library.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "base/files.h"
#include "config/config_text.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::pair<const char*, const char*>, 5> kTextureEndings = {
    {{"_Color", "color"},
     {"_Roughness", "roughness"},
     {"_NormalGL", "normal"},
     {"_Metalness", "metallic"},
     {"_Opacity", "alpha"}}};

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

std::string lower_case_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool is_image(const fs::path& file) {
  const std::string ending = lower_case_ending(file);
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

MaterialConfig plain_material(const std::string& name) {
  MaterialConfig material;
  material.name = name;
  for (NumberSource& c : material.base_color.components) c = number_constant(0.8);
  material.metallic = number_constant(0.0);
  material.roughness = number_constant(0.5);
  material.specular = number_constant(0.5);
  material.transmission = number_constant(0.0);
  material.ior = number_constant(1.45);
  material.clearcoat = number_constant(0.0);
  material.texture_repeat = number_constant(1.0);
  return material;
}

template <class T>
std::vector<std::string> keys_of(const std::map<std::string, T>& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

}  // namespace

Result<MaterialLibrary> MaterialLibrary::open(const std::vector<fs::path>& folders,
                                              const std::vector<MaterialConfig>& own,
                                              AllowedFolders allowed) {
  MaterialLibrary library;
  library.allowed_ = std::move(allowed);
  for (const fs::path& folder : folders) library.allowed_.add(folder);
  for (const MaterialConfig& material : own) library.materials_.emplace(material.name, material);
  for (const fs::path& folder : folders) {
    if (Status added = library.add_folder(folder); !added) return forward_error(added);
  }
  for (const auto& [name, set] : library.texture_sets_) {
    MaterialConfig material = plain_material(name);
    for (NumberSource& c : material.base_color.components) c = number_constant(1.0);
    material.textures = NameSource{{}, {{name, number_constant(1.0)}}};
    library.materials_.emplace(name, material);
  }
  library.materials_.emplace("default", plain_material("default"));
  return library;
}

Status MaterialLibrary::add_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return fail(ErrorKind::kInput, "there is no material folder {}", folder.string());
  }
  const fs::path file = folder / "library.yaml";
  if (fs::is_regular_file(file, error)) {
    if (Status inside = allowed_.check(file, file.string()); !inside) return inside;
    const Result<std::string> text = read_file(file, kLargestConfig);
    if (!text) return forward_error(text);
    const auto materials = read_material_library(*text, file, allowed_);
    if (!materials) return forward_error(materials);
    for (const MaterialConfig& material : *materials) materials_.emplace(material.name, material);
  }
  for (const fs::path& entry : sorted_entries(folder)) add_texture_set(entry);
  for (const fs::path& entry : sorted_entries(folder / "textures")) add_texture_set(entry);
  for (const fs::path& entry : sorted_entries(folder / "hdri")) {
    const std::string ending = lower_case_ending(entry);
    if (ending == ".exr" || ending == ".hdr") hdris_.emplace(entry.stem().string(), entry);
  }
  return {};
}

void MaterialLibrary::add_texture_set(const fs::path& folder) {
  TextureSet set;
  set.name = folder.filename().string();
  for (const fs::path& file : sorted_entries(folder)) {
    const std::string stem = file.stem().string();
    for (const auto& [ending, role] : kTextureEndings) {
      if (stem.ends_with(ending) && is_image(file)) set.files.emplace(role, file);
    }
  }
  if (set.files.contains("color")) texture_sets_.emplace(set.name, set);
}

std::vector<std::string> MaterialLibrary::material_names() const { return keys_of(materials_); }
std::vector<std::string> MaterialLibrary::hdri_names() const { return keys_of(hdris_); }
std::vector<std::string> MaterialLibrary::texture_set_names() const {
  return keys_of(texture_sets_);
}

}  // namespace seedframe
