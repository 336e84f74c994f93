// What is said of one frame's rendering in place of what its config says: in a line of graphs, and
// in a request of a stream.
#pragma once

#include <optional>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "base/pixel_rect.h"
#include "spec/frame_spec.h"

namespace seedframe {

struct RenderingWish {
  std::optional<int> samples = {};   ///< in place of render.samples
  std::optional<bool> denoise = {};  ///< true: as render.denoise says, or by oidn where that is off
  std::optional<PixelRect> crop = {};  ///< only these pixels are rendered; the others are black
  bool depth = false;                  ///< the Depth pass, whether or not render.passes has it

  bool operator==(const RenderingWish&) const = default;
};

/// Takes a key and its value, if it is one of "samples", "denoise", "crop" and "depth"; false if it
/// is not. kInput errors begin with the key.
Result<bool> take_rendering_wish(const std::string& key, const Json& value, RenderingWish& wish);

/// The same keys, without what is not wished.
Json to_json(const RenderingWish& wish);

/// kInput: the crop reaches beyond the image.
Status apply(const RenderingWish& wish, RenderSettings& render);

}  // namespace seedframe
