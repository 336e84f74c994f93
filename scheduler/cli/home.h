// Where the program finds blender_scripts/, assets/ and materials/, and its own library.
#pragma once

#include <filesystem>

namespace seedframe {

/// The environment's SEEDFRAME_HOME, or else the checkout that the program was built from.
std::filesystem::path seedframe_home();

/// Where frames of this machine are noted (campaign/frame_cache.h): the folder that the
/// environment's SEEDFRAME_CACHE names, or ~/.cache/seedframe; empty if that is "off", or there is
/// no home.
std::filesystem::path cache_folder();

/// The library that is preloaded into workers (render/worker_conditions.h): beside the program.
std::filesystem::path worker_preload();

}  // namespace seedframe
