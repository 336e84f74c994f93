// Scene-linear pixels to display pixels through OpenColorIO.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/image.h"
#include "spec/image_settings.h"

namespace seedframe {

/// An OCIO config, loaded once. Thread-safe. The first picture of a display, view and look builds
/// their tables (up to 50 ms); exposure and gamma may then change from picture to picture for free.
class ColorManagement {
 public:
  /// kInput errors: not a config, or one that OCIO cannot read.
  static Result<ColorManagement> load(const std::filesystem::path& ocio_config);
  ~ColorManagement();
  ColorManagement(ColorManagement&&) noexcept;
  ColorManagement& operator=(ColorManagement&&) noexcept;

  /// kInput errors: a display, view or look that the config does not have, with "did you mean"; an
  /// exposure or gamma that is not a usable number.
  Status check(const ImageSettings& settings) const;

  /// RGBA scene-linear float to 8-bit RGB, as Blender would save an opaque film without dithering:
  /// exposure, look, view, gamma, then round(255 v). Alpha is ignored. Errors: those of check().
  Result<Image<std::uint8_t>> apply(const Image<float>& combined,
                                    const ImageSettings& settings) const;

  /// SHA-256 of the config file; the tables that it names beside it are not part of it.
  const std::string& config_hash() const;

 private:
  struct State;
  explicit ColorManagement(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace seedframe
