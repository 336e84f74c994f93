// The layers of a frame that are lines and letters: boxes, outlines, keypoints, names.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "picture/canvas.h"
#include "picture/frame_content.h"
#include "picture/layers.h"

namespace seedframe {

/// How keypoints are joined: for each category (1-based, less 1) pairs of their names.
using Skeletons = std::vector<std::vector<std::array<std::string, 2>>>;

/// Over a canvas that shows the whole frame, `scale` of its pixels for one of the frame. Of objects
/// without a category only masks have outlines. A name for which there is no room is left out: its
/// box has the colour of its class.
void draw_overlays(const FrameContent& content, const LayerSet& layers, double scale,
                   const Skeletons& skeletons, Canvas& canvas);

}  // namespace seedframe
