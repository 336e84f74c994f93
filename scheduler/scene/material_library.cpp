#include "scene/material_library.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "base/files.h"
#include "base/nearest_name.h"
#include "config/config_text.h"
#include "image_files/image_kind.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

struct TextureName {
  const char* ending;  ///< of the stem
  const char* role;
};

constexpr std::array<TextureName, 11> kTextureNames = {{{"_Color", "color"},
                                                        {"_Roughness", "roughness"},
                                                        {"_NormalGL", "normal"},
                                                        {"_Metalness", "metallic"},
                                                        {"_Opacity", "alpha"},
                                                        {"_diff", "color"},
                                                        {"_rough", "roughness"},
                                                        {"_nor_gl", "normal"},
                                                        {"_metal", "metallic"},
                                                        {"_opacity", "alpha"},
                                                        {"_alpha", "alpha"}}};

/// "brick_diff_2k" without its "_2k".
std::string without_resolution(const std::string& stem) {
  const std::size_t bar = stem.rfind('_');
  if (bar == std::string::npos || stem.size() < bar + 3) return stem;
  const auto digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const bool is_resolution =
      (stem.back() == 'k' || stem.back() == 'K') &&
      std::all_of(stem.begin() + static_cast<std::ptrdiff_t>(bar) + 1, stem.end() - 1, digit);
  return is_resolution ? stem.substr(0, bar) : stem;
}

/// What a file is in its set; null if it is nothing.
const char* role_of(const fs::path& file) {
  const std::string stem = without_resolution(file.stem().string());
  for (const TextureName& known : kTextureNames) {
    if (stem.ends_with(known.ending)) return known.role;
  }
  return nullptr;
}

bool is_usual(ImageKind kind) { return kind == ImageKind::kPng || kind == ImageKind::kJpeg; }

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
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
    if (set.is_decal) continue;
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
  for (const fs::path& entry : sorted_entries(folder / "decals")) add_texture_set(entry, true);
  for (const fs::path& entry : sorted_entries(folder / "hdri")) {
    add_hdri(entry);
  }
  return {};
}

void MaterialLibrary::add_texture_set(const fs::path& folder, bool is_decal) {
  TextureSet set;
  set.name = folder.filename().string();
  set.is_decal = is_decal;
  std::vector<fs::path> files = sorted_entries(folder);
  std::stable_partition(files.begin(), files.end(), [](const fs::path& file) {
    const std::optional<ImageKind> kind = image_kind_of(file);
    return kind && is_usual(*kind);
  });
  for (const fs::path& file : files) {
    const char* role = role_of(file);
    if (role == nullptr) continue;
    if (image_kind_of(file)) {
      set.files.emplace(role, file);
    } else if (std::string_view(role) == "color") {
      unread_colors_.emplace(set.name, file);
    }
  }
  if (set.files.contains("color")) texture_sets_.emplace(set.name, set);
}

void MaterialLibrary::add_hdri(const fs::path& file) {
  const std::optional<ImageKind> kind = image_kind_of(file);
  const bool is_linear = kind == ImageKind::kExr || kind == ImageKind::kHdr;
  (is_linear ? hdris_ : unread_hdris_).emplace(file.stem().string(), file);
}

std::string MaterialLibrary::no_material(const std::string& name) const {
  const auto unread = unread_colors_.find(name);
  if (unread != unread_colors_.end()) return no_texture_set(name);
  if (texture_sets_.contains(name)) {
    return "'" + name + "' is a decal, no material: name it in the `textures` of one";
  }
  return "there is no material '" + name + "'" + did_you_mean(name, material_names());
}

std::string MaterialLibrary::no_texture_set(const std::string& name) const {
  const std::string text = "there is no texture set '" + name + "'";
  const auto unread = unread_colors_.find(name);
  if (unread == unread_colors_.end()) return text + did_you_mean(name, texture_set_names());
  return text + ": its colour is " + unread->second.string() + ", and images end in " +
         image_endings();
}

std::string MaterialLibrary::no_hdri(const std::string& name) const {
  const std::string text = "there is no environment map '" + name + "'";
  const auto unread = unread_hdris_.find(name);
  if (unread == unread_hdris_.end()) return text + did_you_mean(name, hdri_names());
  return text + ": environment maps end in .exr or .hdr, not as " + unread->second.string();
}

std::vector<std::string> MaterialLibrary::material_names() const { return keys_of(materials_); }
std::vector<std::string> MaterialLibrary::hdri_names() const { return keys_of(hdris_); }
std::vector<std::string> MaterialLibrary::texture_set_names() const {
  return keys_of(texture_sets_);
}

std::vector<fs::path> MaterialLibrary::image_files() const {
  std::vector<fs::path> files;
  for (const auto& [name, set] : texture_sets_) {
    for (const auto& [role, file] : set.files) files.push_back(file);
  }
  for (const auto& [name, file] : hdris_) files.push_back(file);
  return files;
}

}  // namespace seedframe
