// Whether an image file can be what a material or a world needs of it, before Blender sees it: it
// would paint what is missing in magenta, grey or black, and say nothing.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"
#include "image_files/image_kind.h"

namespace seedframe {

enum class ImageUse {
  kEnvironment,  ///< light: linear, red, green and blue, none below 0
  kColor,        ///< of a surface: sRGB in integers, linear in floats, none below 0
  kData,         ///< roughness, normals, …: numbers
};

/// "environment map", "colour texture", "texture"
const char* name_of(ImageUse use);

/// Decodes all of the file `what`, whose bytes these are. kInput error, which begins with `what`:
/// whatever visit_image refuses; channels in layers, or of another colour model than RGB (grey will
/// do for textures); values that are NaN or infinite, or negative where there are none; several
/// images in one file; floats where Blender could not tell that they are linear. kEnvironment
/// error: see image_files/image_module.h.
Status check_image(std::string_view bytes, ImageKind kind, ImageUse use, const std::string& what);

/// The result of the check of a file's content, kept for all processes of the user. Nothing here is
/// an error: a folder that cannot be used knows nothing.
class CheckedImages {
 public:
  /// In a folder of the user's cache; empty: nothing is kept.
  explicit CheckedImages(std::filesystem::path cache) : cache_(std::move(cache)) {}

  bool is_known_good(const std::string& sha256, ImageKind kind, ImageUse use) const;
  void remember_good(const std::string& sha256, ImageKind kind, ImageUse use) const;

 private:
  std::filesystem::path entry(const std::string& sha256, ImageKind kind, ImageUse use) const;

  std::filesystem::path cache_;
};

}  // namespace seedframe
