// What a frame would be with endless samples, as near as it can be had, and how near that is.
#pragma once

#include <cstdint>

#include "base/error.h"
#include "image/color_management.h"
#include "image/pass_reader.h"
#include "image/rendering_error.h"
#include "scene/prepared_campaign.h"

namespace seedframe {

/// The mean of two halves whose samples are independent of each other and of the frame's own.
struct Reference {
  Picture picture;
  ReferenceVariance variance;
  Image<std::uint16_t> ids;
};

enum class ReferenceHalf { kA, kB };

/// The frame with a seed of its own for this half, drawn from the campaign's. `prepared` is of a
/// reference_variation with half of the reference's samples.
Result<ExpandedFrame> expand_half(const PreparedCampaign& prepared, std::int64_t frame,
                                  ReferenceHalf half);

/// kInput error: the view is unknown to the colours.
Result<Reference> make_reference(const FramePasses& a, const FramePasses& b,
                                 const ColorManagement& color, const ImageSettings& view);

/// The rendering's error, less what is the reference's own.
RenderingError error_against(const Reference& reference, const Picture& rendering);

}  // namespace seedframe
