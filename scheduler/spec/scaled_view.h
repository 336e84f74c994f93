// The same view in more or fewer pixels.
#pragma once

#include "spec/frame_spec.h"

namespace seedframe {

/// The whole image, without a region, with `scale` times as many pixels both ways (at least one):
/// what one of them sees is what as many together saw.
FrameSpec scaled_view(FrameSpec spec, double scale);

}  // namespace seedframe
