// Which OpenColorIO config a Blender works with.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "render/blender_info.h"

namespace seedframe {

/// The config.ocio of a Blender: beside a portable build's program or in the folder of a Python
/// module (<folder>/<X.Y>/datafiles/colormanagement), or where distributions put it
/// (<prefix>/share/blender[/<X.Y>]/datafiles/colormanagement). kEnvironment error with what to do
/// when it is in none of these.
Result<std::filesystem::path> find_ocio_config(const BlenderInfo& blender);

}  // namespace seedframe
