// Where the program finds what belongs to it: in a checkout, or where it was installed.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace seedframe {

/// The folder with blender_scripts/, assets/, materials/ and configs/: the environment's
/// SEEDFRAME_HOME; else share/seedframe of the place that the program is installed in; else, for a
/// program that is still in its build folder, the checkout. kEnvironment: it is not there.
Result<std::filesystem::path> find_home();

/// For verbs that main.cpp starts only if there is one.
std::filesystem::path seedframe_home();

/// Where frames of this machine are noted (cache/frame_cache.h): the folder that the
/// environment's SEEDFRAME_CACHE names, or ~/.cache/seedframe; empty if that is "off", or there is
/// no home.
std::filesystem::path cache_folder();

/// The user's own asset library: seedframe/assets in XDG_DATA_HOME, or in ~/.local/share; empty if
/// there is no home. It need not exist.
std::filesystem::path own_assets();

/// The library that is preloaded into workers (render/worker_conditions.h): beside the program, or
/// in lib/seedframe of the place that it is installed in.
std::filesystem::path worker_preload();

/// What --blender names when it is not given: the module in venv/blender of a checkout, which
/// scripts/setup.sh links to the version that it has installed, or else "blender", looked up in
/// PATH.
std::string default_blender();

}  // namespace seedframe
