// The frames of a campaign as pictures are drawn of them: read from their folders.
#pragma once

#include <cstdint>
#include <functional>

#include "base/error.h"
#include "export/dataset.h"
#include "frames/frame_reader.h"
#include "picture/frame_content.h"
#include "picture/layers.h"
#include "picture/overlays.h"
#include "scene/expanded_frame.h"

namespace seedframe {

/// A frame as the campaign's config has it today. An error: why that is not known.
using FrameExpansion = std::function<Result<ExpandedFrame>(std::int64_t frame)>;

/// What the layers need, found to be as it was written. Layers that the frame does not have are in
/// `absent`; for the disagreement the twin is traced again, by `expand`. kCorrupt errors as
/// FrameReader's.
Result<FrameContent> read_content(const CommittedFrame& frame, const Dataset& dataset,
                                  const LayerSet& layers, const FrameExpansion& expand);

/// Of the dataset's classes.
Skeletons skeletons_of(const Dataset& dataset);

}  // namespace seedframe
