// Takes out of an EXR what would make two renders of one frame differ as files.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace seedframe {

/// The bytes of an EXR, its compressed pixels untouched, without the attributes in which Blender
/// and Cycles note dates, times and hosts; keeps only what OpenEXR itself asks for. kRender errors,
/// which name `what`: bytes that OpenEXR cannot read.
Result<std::string> without_metadata(std::string_view bytes, const std::string& what);

}  // namespace seedframe
