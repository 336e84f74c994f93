// All that a picture of a frame is drawn from.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "annotate/labels.h"
#include "image/image.h"
#include "picture/layers.h"
#include "spec/twin_check.h"

namespace seedframe {

struct FrameContent {
  FrameLabels labels;
  Image<std::uint16_t> instance_ids;
  std::optional<Image<std::uint8_t>> image;  ///< RGB
  std::optional<Image<float>> depth;         ///< planar, metres; kNoDepth where there is nothing
  std::optional<Image<float>> normal;        ///< x, y, z in the camera's frame
  /// Where the index pass has other ids than the twin, as difference_image has it.
  std::optional<Image<std::uint8_t>> disagreement;
  /// Of layers that cannot be shown: why.
  std::map<Layer, std::string> absent;
};

}  // namespace seedframe
