// The section `render` of a config.
#pragma once

#include "config/section_reader.h"

namespace seedframe {

RenderConfig read_render(SectionReader& campaign, Diagnostics& errors);

}  // namespace seedframe
