// The section `image`: how pixels become a picture, and the picture a file.
#pragma once

#include "config/section_reader.h"

namespace seedframe {

/// `render` has the size that the file must be able to hold.
ImageConfig read_image(SectionReader& campaign, const RenderConfig& render);

}  // namespace seedframe
