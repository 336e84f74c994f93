// Where the program finds blender_scripts/, assets/ and materials/.
#pragma once

#include <filesystem>

namespace seedframe {

/// The environment's SEEDFRAME_HOME, or else the checkout that the program was built from.
std::filesystem::path seedframe_home();

}  // namespace seedframe
