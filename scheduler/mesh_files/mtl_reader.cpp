#include "mesh_files/mtl_reader.h"

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/message_text.h"
#include "base/utf8.h"
#include "mesh_files/text_scanner.h"

namespace seedframe {
namespace {

constexpr std::uintmax_t kLargestMtl = std::uintmax_t{64} << 20;
constexpr std::size_t kMostMaterials = kMostImportedSlots;

double clamped(double value, double least, double most) {
  return std::isfinite(value) ? std::clamp(value, least, most) : least;
}

// The name of a file behind options such as "-s 2 2 1"; `placed` becomes true if one of them moves
// or scales the image.
std::string_view image_name(std::string_view words, bool& placed) {
  struct Option {
    std::string_view name;
    int most_arguments;
  };
  constexpr Option kOptions[] = {{"-blendu", 1}, {"-blendv", 1}, {"-boost", 1},   {"-bm", 1},
                                 {"-cc", 1},     {"-clamp", 1},  {"-imfchan", 1}, {"-mm", 2},
                                 {"-o", 3},      {"-s", 3},      {"-t", 3},       {"-texres", 1},
                                 {"-type", 1}};
  for (;;) {
    std::string_view rest = words;
    const std::string_view word = take_word(rest);
    const auto option = std::find_if(std::begin(kOptions), std::end(kOptions),
                                     [word](const Option& known) { return known.name == word; });
    if (option == std::end(kOptions)) return trimmed(words);
    const bool takes_numbers = option->most_arguments > 1;
    for (int i = 0; i < option->most_arguments; ++i) {
      std::string_view behind = rest;
      const auto number = parse_number<double>(take_word(behind));
      if (takes_numbers && !number) break;
      if (option->most_arguments == 3 && number != (word == "-s" ? 1.0 : 0.0)) placed = true;
      rest = behind;
    }
    words = rest;
  }
}

class MtlParser {
 public:
  MtlParser(BesideFiles& files, MeshBuilder& builder) : files_(files), builder_(builder) {}

  std::map<std::string, FileMaterial> parse(const std::string& name) {
    const auto path = files_.find(name);
    const auto text = path ? read_file(*path, kLargestMtl) : Result<std::string>();
    if (!path || !text || is_utf16(*text)) {
      builder_.drop("files of materials that cannot be read give none",
                    "'" + shortened(name, 200) + "'");
      return {};
    }
    std::string_view rest = without_byte_order_mark(*text);
    while (!rest.empty()) {
      std::string_view line = trimmed(take_line(rest));
      parse_line(trimmed(line.substr(0, line.find('#'))));
    }
    return std::move(materials_);
  }

 private:
  void parse_line(std::string_view line) {
    const std::string_view keyword = take_word(line);
    line = trimmed(line);
    if (keyword == "newmtl") {
      if (materials_.size() >= kMostMaterials) return;
      material_ = &materials_[as_utf8(line)];
      *material_ = {};
      has_roughness_ = false;
      return;
    }
    if (material_ == nullptr || keyword.empty()) return;
    if (!take_number_of(keyword, line)) take_image_of(keyword, line);
  }

  // What a keyword with numbers says; false for all others.
  bool take_number_of(std::string_view keyword, std::string_view line) {
    const auto number = parse_number<double>(take_word(line));
    if (keyword == "Kd") {
      const auto green = parse_number<double>(take_word(line));
      const auto blue = parse_number<double>(take_word(line));
      if (number && !material_->textures.contains("color")) {
        material_->base_color = {clamped(*number, 0.0, 1.0),
                                 clamped(green.value_or(*number), 0.0, 1.0),
                                 clamped(blue.value_or(*number), 0.0, 1.0)};
      }
      return true;
    }
    const double value = number.value_or(0.0);
    if (keyword == "Ns") {
      if (number && !has_roughness_) {
        material_->roughness = 1.0 - std::sqrt(clamped(value, 0.0, 1000.0) / 1000.0);
      }
    } else if (keyword == "Pr") {
      material_->roughness = clamped(value, 0.0, 1.0);
      has_roughness_ = true;
    } else if (keyword == "Pm") {
      material_->metallic = clamped(value, 0.0, 1.0);
    } else if (keyword == "Pc") {
      material_->clearcoat = clamped(value, 0.0, 1.0);
    } else if (keyword == "Ni") {
      if (number) material_->ior = clamped(value, 1.0, 5.0);
    } else if (keyword == "d" || keyword == "Tr") {
      const double opacity = clamped(keyword == "d" ? value : 1.0 - value, 0.0, 1.0);
      if (number && opacity < 1.0 && !material_->textures.contains("alpha")) {
        material_->textures["alpha"].factor = opacity;
      }
    } else if (keyword == "Ke") {
      if (value > 0.0) builder_.not_kept("light that materials give off");
    } else {
      return false;
    }
    return true;
  }

  void take_image_of(std::string_view keyword, std::string_view line) {
    const std::pair<std::string_view, const char*> roles[] = {
        {"map_Kd", "color"}, {"map_Pr", "roughness"}, {"map_Pm", "metallic"},
        {"map_d", "alpha"},  {"map_Kn", "normal"},    {"norm", "normal"}};
    for (const auto& [name, role] : roles) {
      if (keyword != name) continue;
      bool placed = false;
      const std::string file(image_name(line, placed));
      if (placed) builder_.not_kept("where materials place their images");
      auto image = files_.image(file);
      if (!image) return;
      material_->textures[role] = {.image = std::move(image), .factor = 1.0};
      if (std::string_view(role) == "color") material_->base_color = {1.0, 1.0, 1.0};
      return;
    }
    if (keyword.starts_with("map_") || keyword == "bump" || keyword == "disp" ||
        keyword == "refl" || keyword == "decal") {
      builder_.not_kept(fmt::format("images of the kind '{}'", shortened(keyword, 40)));
    }
  }

  BesideFiles& files_;
  MeshBuilder& builder_;
  std::map<std::string, FileMaterial> materials_;
  FileMaterial* material_ = nullptr;
  bool has_roughness_ = false;  // in Pr, which counts more than Ns
};

}  // namespace

std::map<std::string, FileMaterial> read_mtl(const std::string& name, BesideFiles& files,
                                             MeshBuilder& builder) {
  return MtlParser(files, builder).parse(name);
}

}  // namespace seedframe
