// Materials by name: those of the config, of library files, and one for each texture set.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/campaign_config.h"

namespace seedframe {

/// Image files of one physical surface, by the names that libraries give them (the resolution, as
/// _2k, may follow):
///
/// | library                | color  | roughness  | normal    | metallic   | alpha            |
/// | ambientCG, CC-Textures | _Color | _Roughness | _NormalGL | _Metalness | _Opacity         |
/// | Poly Haven             | _diff  | _rough     | _nor_gl   | _metal     | _opacity, _alpha |
///
/// PNG and JPEG files come before others of the same role. Normal maps for DirectX (_NormalDX,
/// _nor_dx) are left alone: green points the other way in them.
struct TextureSet {
  std::string name;
  std::map<std::string, std::filesystem::path>
      files;              ///< "color", "roughness", "normal", "metallic", "alpha"
  bool is_decal = false;  ///< a print, such as a number: no surface to make anything of
};

class MaterialLibrary {
 public:
  /// Reads <folder>/library.yaml where it exists, and takes each folder <folder>/<name>/ or
  /// <folder>/textures/<name>/ that has a colour file for a texture set, and
  /// <folder>/decals/<name>/ for one that is a decal. What `own` names comes before the library's;
  /// an earlier folder comes before a later one. Files lie in one of the folders or in an allowed
  /// one, also after symbolic links are followed: for a library.yaml that is checked here, for
  /// images by whoever opens them.
  static Result<MaterialLibrary> open(const std::vector<std::filesystem::path>& folders,
                                      const std::vector<MaterialConfig>& own,
                                      AllowedFolders allowed = {});

  /// Each by its name; a texture set is a material too, plain but for its textures. A decal is not.
  const std::map<std::string, MaterialConfig>& materials() const { return materials_; }
  const std::map<std::string, TextureSet>& texture_sets() const { return texture_sets_; }
  std::vector<std::string> material_names() const;
  std::vector<std::string> texture_set_names() const;
  /// Why there is none of that name, for a message: names the file whose ending alone keeps it from
  /// being one, or else names that are near.
  std::string no_material(const std::string& name) const;
  std::string no_texture_set(const std::string& name) const;
  std::string no_hdri(const std::string& name) const;
  /// Environment maps, <folder>/hdri/<name>.exr or .hdr: name to file.
  const std::map<std::string, std::filesystem::path>& hdris() const { return hdris_; }
  std::vector<std::string> hdri_names() const;
  /// Of all texture sets, and the environment maps.
  std::vector<std::filesystem::path> image_files() const;
  const AllowedFolders& allowed() const { return allowed_; }

 private:
  Status add_folder(const std::filesystem::path& folder);
  void add_texture_set(const std::filesystem::path& folder, bool is_decal = false);
  void add_hdri(const std::filesystem::path& file);

  AllowedFolders allowed_;
  std::map<std::string, MaterialConfig> materials_;
  std::map<std::string, TextureSet> texture_sets_;
  std::map<std::string, std::filesystem::path> hdris_;
  /// By name: files that are right but for their ending.
  std::map<std::string, std::filesystem::path> unread_colors_, unread_hdris_;
};

}  // namespace seedframe
