#include "assets/asset_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "assets/image_check.h"
#include "base/sha256.h"
#include "image/png_file.h"
#include "image_files/image_kind.h"
#include "image_files/image_reader.h"

namespace seedframe {
namespace {

constexpr std::array<const char*, 5> kRoles = {"alpha", "color", "metallic", "normal", "roughness"};

struct Ending {
  ImageKind kind;
  const char* text;
};
// TGA last: anything begins like one.
constexpr std::array<Ending, 8> kEndings = {{{ImageKind::kPng, ".png"},
                                             {ImageKind::kJpeg, ".jpg"},
                                             {ImageKind::kTiff, ".tif"},
                                             {ImageKind::kExr, ".exr"},
                                             {ImageKind::kHdr, ".hdr"},
                                             {ImageKind::kWebp, ".webp"},
                                             {ImageKind::kBmp, ".bmp"},
                                             {ImageKind::kTga, ".tga"}}};

// Names of files lie, and images within glTF files have none.
std::optional<Ending> ending_of(const FileImage& image) {
  const bool is_tga = image_kind_of(image.name) == ImageKind::kTga;
  const auto* const found =
      std::find_if(kEndings.begin(), kEndings.end(), [&](const Ending& ending) {
        return begins_like(image.bytes, ending.kind) && (ending.kind != ImageKind::kTga || is_tga);
      });
  if (found == kEndings.end()) return std::nullopt;
  return *found;
}

double* number_of(MaterialSpec& spec, std::string_view role) {
  if (role == "metallic") return &spec.metallic;
  if (role == "roughness") return &spec.roughness;
  return nullptr;
}

// One channel of an image as grey, times the factor.
Result<Image<std::uint8_t>> channel_of(const FileTexture& texture, ImageKind kind) {
  const auto image = decode_image(texture.image->bytes, kind, texture.image->name);
  if (!image) return forward_error(image);
  const int wanted = texture.channel.value_or(0);
  const bool wants_alpha = wanted == 3;
  const bool has_alpha = image->channels == 2 || image->channels >= 4;
  const int alpha = image->channels == 2 ? 1 : 3;
  const int channel = wants_alpha ? alpha : std::min(wanted, image->channels < 3 ? 0 : 2);
  Image<std::uint8_t> grey(image->width, image->height, 1);
  const auto step = static_cast<std::size_t>(image->channels);
  for (std::size_t i = 0; i < grey.values.size(); ++i) {
    const double stored = wants_alpha && !has_alpha
                              ? 1.0
                              : image->values[i * step + static_cast<std::size_t>(channel)];
    double value = texture.factor * (std::isfinite(stored) ? std::clamp(stored, 0.0, 1.0) : 0.0);
    if (texture.cutoff) value = value >= *texture.cutoff ? 1.0 : 0.0;
    grey.values[i] = static_cast<std::uint8_t>(std::lround(255.0 * value));
  }
  return grey;
}

class Maker {
 public:
  void add(const std::string& slot, const FileMaterial& source) {
    AssetMaterial material;
    MaterialSpec& spec = material.spec;
    spec.base_color = source.base_color;
    spec.metallic = source.metallic;
    spec.roughness = source.roughness;
    spec.specular = source.specular;
    spec.transmission = source.transmission;
    spec.ior = source.ior;
    spec.clearcoat = source.clearcoat;
    for (const auto& [role, texture] : source.textures) {
      if (Status added = add_texture(role, texture, material); !added) {
        made_.dropped.push_back(fmt::format("an image of the material '{}' is left out: {}", slot,
                                            added.error().message));
      }
    }
    made_.materials.emplace(slot, std::move(material));
  }

  MadeMaterials take() { return std::move(made_); }

 private:
  Status add_texture(const std::string& role, const FileTexture& texture, AssetMaterial& material) {
    if (!texture.image) {  // the same everywhere
      Image<std::uint8_t> pixel(1, 1, 1);
      const bool on = !texture.cutoff || texture.factor >= *texture.cutoff;
      const double value = !texture.cutoff ? texture.factor : on ? 1.0 : 0.0;
      pixel.values[0] = static_cast<std::uint8_t>(std::lround(255.0 * value));
      if (pixel.values[0] < 255) keep(role, encode_png(pixel), ".png", material);
      return {};
    }
    const auto ending = ending_of(*texture.image);
    if (!ending) {
      return fail(ErrorKind::kInput, "{} is no image of a kind that is read ({})",
                  texture.image->name, image_endings());
    }
    const ImageUse use = role == "color" ? ImageUse::kColor : ImageUse::kData;
    Status good = check_image(texture.image->bytes, ending->kind, use, texture.image->name);
    if (!good) return good;
    if (!texture.channel) {
      keep(role, texture.image->bytes, ending->text, material);
      return {};
    }
    const auto grey = channel_of(texture, ending->kind);
    if (!grey) return forward_error(grey);
    const auto [least, most] = std::minmax_element(grey->values.begin(), grey->values.end());
    double* const number = number_of(material.spec, role);
    if (*least == *most && number != nullptr) {
      *number = *most / 255.0;
    } else if (role != "alpha" || *least < 255) {
      keep(role, encode_png(*grey), ".png", material);
    }
    return {};
  }

  void keep(const std::string& role, const std::string& bytes, const char* ending,
            AssetMaterial& material) {
    const std::string sha256 = sha256_hex(bytes);
    const std::string file = "textures/" + sha256.substr(0, 16) + ending;
    material.spec.textures[role] = sha256;
    material.files[role] = file;
    made_.files[file] = bytes;
  }

  MadeMaterials made_;
};

Status read_number(const Json& json, const char* key, double least, double most,
                   const std::string& what, double& out) {
  const auto number = json_field<double>(json, key, what);
  if (!number) return forward_error(number);
  if (!(*number >= least && *number <= most)) {
    return fail(ErrorKind::kCorrupt, "{}: '{}' must be from {} to {}, found {}", what, key, least,
                most, *number);
  }
  out = *number;
  return {};
}

Status read_textures(const Json& json, const std::string& what, AssetMaterial& out) {
  const auto textures = json_field<Json>(json, "textures", what);
  if (!textures) return forward_error(textures);
  if (!textures->is_object()) {
    return fail(ErrorKind::kCorrupt, "{}: 'textures' must be an object", what);
  }
  for (const auto& [role, texture] : textures->items()) {
    const std::string place = fmt::format("{}: textures.{}", what, role);
    const auto file = json_field<std::string>(texture, "file", place);
    if (!file) return forward_error(file);
    const auto sha256 = json_field<std::string>(texture, "sha256", place);
    if (!sha256) return forward_error(sha256);
    const bool is_role = std::find(kRoles.begin(), kRoles.end(), role) != kRoles.end();
    const std::string_view name =
        std::string_view(*file).substr(std::min<std::size_t>(9, file->size()));
    const bool inside = file->starts_with("textures/") && !name.empty() &&
                        name.find('/') == std::string_view::npos && !name.starts_with('.');
    if (!is_role || !inside || !image_kind_of(*file)) {
      return fail(ErrorKind::kCorrupt,
                  "{}: expected an image in textures/ for alpha, color, metallic, normal or "
                  "roughness, found '{}'",
                  place, *file);
    }
    out.files[role] = *file;
    out.spec.textures[role] = *sha256;
  }
  return {};
}

Status read_material(const Json& json, const std::string& what, AssetMaterial& out) {
  MaterialSpec& spec = out.spec;
  const auto color = json_field<std::vector<double>>(json, "base_color", what);
  if (!color) return forward_error(color);
  const bool good = color->size() == 3 && std::all_of(color->begin(), color->end(), [](double c) {
                      return c >= 0.0 && c <= 1.0;
                    });
  if (!good) {
    return fail(ErrorKind::kCorrupt, "{}: 'base_color' must be three numbers from 0 to 1", what);
  }
  std::copy(color->begin(), color->end(), spec.base_color.begin());
  const std::tuple<const char*, double, double, double*> numbers[] = {
      {"metallic", 0.0, 1.0, &spec.metallic}, {"roughness", 0.0, 1.0, &spec.roughness},
      {"specular", 0.0, 1.0, &spec.specular}, {"transmission", 0.0, 1.0, &spec.transmission},
      {"ior", 1.0, 5.0, &spec.ior},           {"clearcoat", 0.0, 1.0, &spec.clearcoat}};
  for (const auto& [key, least, most, number] : numbers) {
    if (Status read = read_number(json, key, least, most, what, *number); !read) return read;
  }
  return read_textures(json, what, out);
}

}  // namespace

MadeMaterials make_materials(const std::map<std::string, FileMaterial>& materials,
                             const std::vector<std::string>& slots) {
  Maker maker;
  for (const std::string& slot : slots) {
    const auto found = materials.find(slot);
    if (found != materials.end()) maker.add(slot, found->second);
  }
  return maker.take();
}

Json to_json(const AssetMaterials& materials) {
  Json json = Json::object();
  for (const auto& [slot, material] : materials) {
    const MaterialSpec& spec = material.spec;
    Json textures = Json::object();
    for (const auto& [role, file] : material.files) {
      textures[role] = {{"file", file}, {"sha256", spec.textures.at(role)}};
    }
    json[slot] = {{"base_color", spec.base_color},     {"metallic", spec.metallic},
                  {"roughness", spec.roughness},       {"specular", spec.specular},
                  {"transmission", spec.transmission}, {"ior", spec.ior},
                  {"clearcoat", spec.clearcoat},       {"textures", textures}};
  }
  return json;
}

Result<AssetMaterials> materials_from_json(const Json& json, const std::string& what) {
  if (!json.is_object()) {
    return fail(ErrorKind::kCorrupt, "{}: expected an object with slots as keys", what);
  }
  AssetMaterials materials;
  for (const auto& [slot, material] : json.items()) {
    Status read = read_material(material, fmt::format("{}.{}", what, slot), materials[slot]);
    if (!read) return forward_error(read);
  }
  return materials;
}

}  // namespace seedframe
