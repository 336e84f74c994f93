// What a Blender says that it can do.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "render/blender_program.h"

namespace seedframe {

struct BlenderDescription {
  std::string devices, denoisers, kernel, embree;  ///< as ReadyMessage has them
};

/// Starts it as a worker would be, to ask. kEnvironment: it does not start, or cannot say.
Result<BlenderDescription> describe_blender(const BlenderProgram& blender,
                                            const std::filesystem::path& scripts,
                                            const std::filesystem::path& preload);

/// Reads what blender_scripts/describe_blender.py prints.
Result<BlenderDescription> parse_blender_description(const std::string& output);

}  // namespace seedframe
