// A frame of a config, looked at before the campaign is made.
#pragma once

#include <cstdint>

#include "picture/frame_content.h"

namespace seedframe {

struct PreviewedFrame {
  std::int64_t index = 0;
  FrameContent content;  ///< of fewer pixels than the frame will have
  double scale = 1.0;    ///< pixels of the full image for one of the content's
};

}  // namespace seedframe
