// The files that an OpenColorIO config names.
#pragma once

#include <filesystem>

#include <OpenColorIO/OpenColorIO.h>

#include "base/error.h"

namespace seedframe {

/// Looks at every table that a colour space, a look or a view transform of the config names, and at
/// those that these refer to, before OpenColorIO opens them. kInput errors: one is outside of
/// `folder`, or refers to itself.
Status check_color_tables(const OCIO_NAMESPACE::Config& config,
                          const std::filesystem::path& folder);

}  // namespace seedframe
