// Frames that are a part of their image: the region around all objects, and patches of one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "config/campaign_config.h"
#include "rays/pixel_camera.h"
#include "scene/frame_draft.h"

namespace seedframe {

/// The pinhole of a draft whose camera is placed.
PixelCamera pixel_camera_of(const FrameDraft& draft);

/// The pixels that what has an id may show in, and one more on each side; a single pixel if nothing
/// does. The draft's instances are relative to its camera.
PixelRect region_of_objects(const FrameDraft& draft);

/// Turns frames into pictures of one of their objects.
class PatchWindow {
 public:
  PatchWindow(const PatchConfig& config, std::uint64_t seed);

  /// One of `seen`, which are indices into draft.placed and not empty: first a category is drawn,
  /// each as likely, then one of its instances.
  std::size_t choose(const FrameDraft& draft, const std::vector<std::size_t>& seen,
                     const EvaluationContext& context) const;

  /// The camera stays where it is and sees what the instance spans of the image, at the patch's
  /// resolution: the same rays, but for where pixels begin and end.
  void cut(FrameDraft& draft, std::size_t target) const;

 private:
  const PatchConfig& config_;
  PhiloxStream stream_;
};

}  // namespace seedframe
