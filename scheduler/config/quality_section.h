// The section `quality` of a config.
#pragma once

#include <optional>

#include "config/campaign_config.h"
#include "config/section_reader.h"

namespace seedframe {

/// Settings that it would choose itself are errors: `render` and `labels` must have been read.
std::optional<QualityWish> read_quality(SectionReader& campaign, const RenderConfig& render,
                                        const LabelConfig& labels);

}  // namespace seedframe
