// Where the program finds blender_scripts/, assets/ and materials/, and its own library.
#pragma once

#include <filesystem>

namespace seedframe {

/// The environment's SEEDFRAME_HOME, or else the checkout that the program was built from.
std::filesystem::path seedframe_home();

/// The library that is preloaded into workers (render/worker_conditions.h): beside the program.
std::filesystem::path worker_preload();

}  // namespace seedframe
