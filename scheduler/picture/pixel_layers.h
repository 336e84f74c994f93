// The layers of a frame that are pixels: its image, depth, normals, and masks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "image/image.h"
#include "picture/frame_content.h"
#include "picture/label_colors.h"
#include "picture/layers.h"

namespace seedframe {

/// What is beneath where nothing is shown.
inline constexpr DisplayColor kBackdrop = {0.13, 0.14, 0.16};

/// Pixels of a disagreement: inside of objects, at their edges, and where surfaces coincide.
inline constexpr DisplayColor kInsideColor = {1.00, 0.20, 0.45};
inline constexpr DisplayColor kEdgeColor = {0.95, 0.70, 0.10};
inline constexpr DisplayColor kCoincidentColor = {0.35, 0.75, 1.00};

/// Of a pixel as difference_image has it, not 0.
DisplayColor disagreement_color(std::uint8_t kind);

/// The colour of each instance with an id, by that: shades of its class's colour, or that itself.
std::map<int, DisplayColor> instance_colors(const FrameLabels& labels);

/// Where the depth of a frame begins and ends, metres, the nearest and the farthest hundredth left
/// out; nothing where nothing is seen.
std::optional<std::array<double, 2>> depth_range(const Image<float>& depth);

/// How many pixels of a disagreement are of each kind.
struct DisagreementCount {
  std::int64_t inside_px = 0, edge_px = 0, coincident_px = 0;
};
DisagreementCount count_disagreement(const Image<std::uint8_t>& disagreement);

/// RGB, of the frame's size. The content has the layers.
Image<std::uint8_t> pixels_of(const FrameContent& content, const LayerSet& layers);

}  // namespace seedframe
