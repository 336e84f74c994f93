// Whether an OpenColorIO config from a stranger can be used, found out where it can do no harm.
#pragma once

#include <chrono>
#include <filesystem>

#include "base/error.h"
#include "spec/image_settings.h"

namespace seedframe {

/// OpenColorIO reads many formats of tables, and its readers were not made for files that mean
/// ill: some end the program, some never end. So the config is loaded, and one pixel taken through
/// it as `settings` want, in a process of its own first, with `seconds` of time and 2 GB of memory
/// more than ours. kInput errors: it ended otherwise than it should, or said what was wrong.
/// Settings that the config does not know are no error here.
Status try_color_config(const std::filesystem::path& ocio_config, const ImageSettings& settings,
                        std::chrono::seconds seconds = std::chrono::seconds(20));

}  // namespace seedframe
