// A look at some frames of a config by their twins: in less than a second, without Blender.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "preview/previewed_frame.h"
#include "scene/expander.h"

namespace seedframe {

/// Their images are shaded (twin_shading.h), at most `most_width` pixels wide, all with the same
/// exposure; labels are as a rendering of that size would have them.
Result<std::vector<PreviewedFrame>> preview_by_twin(const SceneExpander& expander,
                                                    const std::vector<std::string>& categories,
                                                    const std::vector<std::int64_t>& frames,
                                                    int most_width);

}  // namespace seedframe
