// Scene-linear pixels to display pixels through OpenColorIO.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// Names as in the OCIO config; the exposure multiplies by 2^stops before, the gamma applies after the view.
struct ViewSettings {
  std::string display;
  std::string view;
  std::string look;  ///< "None" or empty for none
  double exposure_stops = 0.0;
  double gamma = 1.0;
};

/// An OCIO config, loaded once. Thread-safe.
class ColorManagement {
 public:
  /// kInput errors: not a config, or one that OCIO cannot read.
  static Result<ColorManagement> load(const std::filesystem::path& ocio_config);
  ~ColorManagement();
  ColorManagement(ColorManagement&&) noexcept;
  ColorManagement& operator=(ColorManagement&&) noexcept;

  /// An error with "did you mean" when the config has no such display, view or look.
  Status check(const ViewSettings& settings) const;

  /// RGBA scene-linear float (premultiplied) to 8-bit RGB as Blender would save it, without dithering.
  Result<Image<std::uint8_t>> apply(const Image<float>& combined, const ViewSettings& settings) const;

  /// SHA-256 of the config file.
  const std::string& config_hash() const;

 private:
  struct State;
  explicit ColorManagement(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace seedframe
