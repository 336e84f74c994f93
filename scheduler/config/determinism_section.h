// The section of a config that says what a campaign promises of its pixels.
#pragma once

#include "config/campaign_config.h"
#include "config/section_reader.h"

namespace seedframe {

/// Settings that would break the promise are errors: `render` must have been read.
Determinism read_determinism(SectionReader& campaign, const RenderConfig& render);

}  // namespace seedframe
