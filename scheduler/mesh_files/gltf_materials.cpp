#include "mesh_files/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace seedframe {
namespace {

// object[key], an object; an empty one if there is none.
Json section_of(const Json& object, const char* key) {
  const Json found = object.is_object() ? object.value(key, Json::object()) : Json::object();
  return found.is_object() ? found : Json::object();
}

double number_of(const Json& object, const char* key, double missing, double least, double most) {
  const Json found = object.value(key, Json());
  if (!found.is_number() || !std::isfinite(found.get<double>())) return missing;
  return std::clamp(found.get<double>(), least, most);
}

double share_of(const Json& object, const char* key, double missing) {
  return number_of(object, key, missing, 0.0, 1.0);
}

}  // namespace

// "glTF 2.0 Specification", section 3.9.
FileMaterial GltfMaterials::read(const Json& material) {
  FileMaterial out;
  const Json pbr = section_of(material, "pbrMetallicRoughness");
  out.base_color = {1.0, 1.0, 1.0};
  const Json factor = pbr.value("baseColorFactor", Json());
  for (std::size_t i = 0; factor.is_array() && i < 3 && i < factor.size(); ++i) {
    if (factor[i].is_number()) out.base_color[i] = std::clamp(factor[i].get<double>(), 0.0, 1.0);
  }
  out.metallic = share_of(pbr, "metallicFactor", 1.0);
  out.roughness = share_of(pbr, "roughnessFactor", 1.0);
  if (auto image = image_of(pbr, "baseColorTexture")) out.textures["color"].image = image;
  if (auto image = image_of(pbr, "metallicRoughnessTexture")) {
    out.textures["roughness"] = {.image = image, .channel = 1, .factor = out.roughness};
    out.textures["metallic"] = {.image = image, .channel = 2, .factor = out.metallic};
  }
  if (auto image = image_of(material, "normalTexture")) out.textures["normal"].image = image;
  read_opacity(material, pbr, out);
  read_extensions(material, out);
  const Json emissive = material.value("emissiveFactor", Json());
  const bool shines =
      emissive.is_array() && std::any_of(emissive.begin(), emissive.end(), [](const Json& value) {
        return value.is_number() && value.get<double>() > 0.0;
      });
  if (shines) builder_.not_kept("light that materials give off");
  if (material.contains("occlusionTexture")) builder_.not_kept("images of occlusion");
  return out;
}

void GltfMaterials::read_opacity(const Json& material, const Json& pbr, FileMaterial& out) {
  const Json mode = material.value("alphaMode", Json("OPAQUE"));
  if (mode != "MASK" && mode != "BLEND") return;
  const Json factor = pbr.value("baseColorFactor", Json());
  const bool has_alpha = factor.is_array() && factor.size() > 3 && factor[3].is_number();
  FileTexture opacity{.image = nullptr, .channel = 3};
  opacity.factor = has_alpha ? std::clamp(factor[3].get<double>(), 0.0, 1.0) : 1.0;
  if (mode == "MASK") opacity.cutoff = share_of(material, "alphaCutoff", 0.5);
  const auto color = out.textures.find("color");
  if (color != out.textures.end()) opacity.image = color->second.image;
  if (opacity.image || opacity.factor < 1.0) out.textures["alpha"] = opacity;
}

void GltfMaterials::read_extensions(const Json& material, FileMaterial& out) {
  const Json extensions = section_of(material, "extensions");
  out.ior = number_of(section_of(extensions, "KHR_materials_ior"), "ior", 1.5, 1.0, 5.0);
  out.transmission =
      share_of(section_of(extensions, "KHR_materials_transmission"), "transmissionFactor", 0.0);
  out.clearcoat =
      share_of(section_of(extensions, "KHR_materials_clearcoat"), "clearcoatFactor", 0.0);
  for (const auto& [name, extension] : extensions.items()) {
    const bool known = name == "KHR_materials_ior" || name == "KHR_materials_transmission" ||
                       name == "KHR_materials_clearcoat";
    if (!known) builder_.not_kept(fmt::format("the extension {} of materials", name));
  }
}

std::shared_ptr<const FileImage> GltfMaterials::image_of(const Json& material, const char* key) {
  const Json use = section_of(material, key);
  const auto number = gltf_index(use, "index");
  if (!number) return nullptr;
  if (gltf_index(use, "texCoord", 0) != std::uint64_t{0}) {
    builder_.not_kept("images on UV sets beyond the first");
    return nullptr;
  }
  if (section_of(use, "extensions").contains("KHR_texture_transform")) {
    builder_.not_kept("where materials place their images");
  }
  const auto texture = file_.entry("textures", *number);
  auto image = texture ? gltf_index(**texture, "source") : std::nullopt;
  if (texture && !image) {
    image =
        gltf_index(section_of(section_of(**texture, "extensions"), "EXT_texture_webp"), "source");
  }
  if (image) return load(*image);
  builder_.drop("images that cannot be read are left out", fmt::format("textures[{}]", *number));
  return nullptr;
}

std::shared_ptr<const FileImage> GltfMaterials::load(std::uint64_t image) {
  const auto [known, is_new] = images_.try_emplace(image);
  if (!is_new) return known->second;
  const std::string place = fmt::format("images[{}]", image);
  auto bytes = file_.read_image(image);
  if (bytes && image_bytes_ + bytes->size() <= kMostImageBytes) {
    image_bytes_ += bytes->size();
    known->second = std::make_shared<const FileImage>(
        FileImage{fmt::format("{}: {}", file_.name(), place), std::move(*bytes)});
  } else {
    builder_.drop("images that cannot be read are left out", place);
  }
  return known->second;
}

}  // namespace seedframe
