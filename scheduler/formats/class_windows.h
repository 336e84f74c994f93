// Windows of an image that hold nothing but some classes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "annotate/labels.h"
#include "base/philox.h"
#include "base/pixel_rect.h"
#include "image/image.h"

namespace seedframe {

/// For each pixel the category of its instance; 0 for background and distractors.
Image<std::uint8_t> class_image(const FrameLabels& labels,
                                const Image<std::uint16_t>& instance_ids);

struct WindowRule {
  int category = 0;
  std::vector<int> beside = {};  ///< other categories that its windows may show
  int min_side = 1;              ///< pixels
};

/// What a window shows at least of its own class, as a share of its pixels.
constexpr double kLeastOwnShare = 0.1;
/// Sides are drawn from here on, unless the rule asks for longer ones, the image is smaller.
constexpr int kLeastWindowSide = 16;

/// A square of which every pixel is of the rule's category or of those beside it, and at least
/// kLeastOwnShare of the category. Its side is log-uniform from the least one to half the image's
/// shorter side, and becomes smaller until there is room; its place is any of those with equal
/// probability. None: there is no room. A pure function of its arguments.
std::optional<PixelRect> draw_window(const Image<std::uint8_t>& classes, const WindowRule& rule,
                                     const PhiloxStream& sides, const PhiloxStream& places,
                                     const PhiloxStream::Position& position);

}  // namespace seedframe
