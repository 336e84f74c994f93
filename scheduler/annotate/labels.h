// The labels of one frame, derived from the instance-id image and the frame spec.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "image/image.h"
#include "scene/frame_spec.h"

namespace seedframe {

/// Tight box of a mask; x0 = smallest column, width = largest - smallest + 1. Pixels.
struct PixelBox {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  bool operator==(const PixelBox&) const = default;
};

struct InstanceLabel {
  int id = 0;                ///< value in instances.png
  int category = 0;          ///< 1-based; 0: a distractor
  std::string name;          ///< "<object>/<copy>"
  std::int64_t area_px = 0;  ///< visible pixels; 0: wholly hidden or out of view
  PixelBox box;              ///< of the visible pixels; all 0 when there are none
};

struct FrameLabels {
  int width = 0;
  int height = 0;
  /// Every instance of the spec with an id, in the spec's order.
  std::vector<InstanceLabel> instances;
};

/// An id in the image that the spec does not have is a kRender error.
Result<FrameLabels> make_labels(const FrameSpec& spec, const Image<std::uint16_t>& instance_ids);

/// For each pixel the category of its instance, 0 for background and distractors.
Image<std::uint8_t> semantic_image(const FrameSpec& spec, const Image<std::uint16_t>& instance_ids);

Json to_json(const FrameLabels& labels);
Result<FrameLabels> labels_from_json(const Json& json, const std::string& what);

}  // namespace seedframe
