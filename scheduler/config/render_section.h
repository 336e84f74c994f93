// The sections `render` and `patches` of a config.
#pragma once

#include <optional>

#include "config/section_reader.h"

namespace seedframe {

RenderConfig read_render(SectionReader& campaign, Diagnostics& errors);

/// `render` must have been read.
std::optional<PatchConfig> read_patches(SectionReader& campaign, const RenderConfig& render);

}  // namespace seedframe
