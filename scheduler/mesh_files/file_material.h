// A material as a mesh file has it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace seedframe {

/// Of all images of a mesh file together.
inline constexpr std::uintmax_t kMostImageBytes = std::uintmax_t{1} << 30;

/// The bytes of an image file.
struct FileImage {
  std::string name;  ///< for messages: a path, or a place in a glTF file
  std::string bytes;
};

/// What of an image a material uses.
struct FileTexture {
  std::shared_ptr<const FileImage> image;  ///< null: the factor alone
  std::optional<int> channel = {};         ///< from 0; nothing: all, or its grey
  double factor = 1.0;                     ///< multiplies the channel
  std::optional<double> cutoff = {};       ///< 1 from here on, 0 below
};

/// Numbers as MaterialSpec has them; a texture replaces its number, but the colour's is multiplied.
struct FileMaterial {
  std::array<double, 3> base_color = {0.8, 0.8, 0.8};  ///< linear Rec.709
  double metallic = 0.0;
  double roughness = 0.5;
  double specular = 0.5;
  double transmission = 0.0;
  double ior = 1.45;
  double clearcoat = 0.0;
  std::map<std::string, FileTexture> textures;  ///< "alpha", "color", "metallic", "normal", …
};

}  // namespace seedframe
