// The library that has OpenImageIO behind it, opened when it is first needed: it brings more than
// two hundred others, and most runs of the program need none of them.
#pragma once

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "image_files/module_table.h"

namespace seedframe {

/// Opened at the first call, from any thread; the answer stays the same. kEnvironment error: it is
/// missing, cannot be loaded, or is of another build; the message says what to install.
Result<const image_module::Table*> image_module_table();

/// The first of `places` that exists.
Result<const image_module::Table*> open_image_module(
    const std::vector<std::filesystem::path>& places);

}  // namespace seedframe
