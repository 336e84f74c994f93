// What of a frame is not rendered, because nobody needs it.
#pragma once

#include <string>
#include <vector>

#include "spec/frame_spec.h"

namespace seedframe {

struct LeftOut {
  std::string what;
  std::string why;  ///< names the keys of the config that would bring it back
};

/// Nothing here changes a pixel or a label that is kept.
std::vector<LeftOut> left_out(const FrameSpec& spec);

}  // namespace seedframe
