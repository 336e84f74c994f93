// One frame as a picture: layers of its images and labels over each other.
#pragma once

#include <cstdint>
#include <string>

#include "image/image.h"
#include "picture/frame_content.h"
#include "picture/layers.h"
#include "picture/overlays.h"

namespace seedframe {

/// How large frames of a size are shown.
struct TileSize {
  int width = 0;       ///< pixels
  int height = 0;      ///< pixels
  double scale = 1.0;  ///< pixels of the tile for one of the frame
};

/// As wide as can be and not wider than `most_width`: a larger frame is shrunk to it, a smaller one
/// is as it is, or a whole number of times as large where it would be less than `least_width` wide.
TileSize tile_size(int frame_width, int frame_height, int most_width, int least_width = 0);

struct FramePicture {
  Image<std::uint8_t> pixels;  ///< RGB, of the tile's size
  std::string note;            ///< numbers that belong to it: "0.41 to 0.72 m"
};

/// Layers that the frame does not have are left out, and the note says so; a tile of nothing else
/// says why.
FramePicture draw_frame(const FrameContent& content, const LayerSet& layers, const TileSize& size,
                        const Skeletons& skeletons = {});

/// A tile for a frame that cannot be shown: "failed", and why.
Image<std::uint8_t> draw_message(const std::string& title, const std::string& text,
                                 const TileSize& size);

}  // namespace seedframe
