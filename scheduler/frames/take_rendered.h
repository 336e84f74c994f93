// What a worker made, taken out of its reach before anybody reads it.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace seedframe {

/// Moves the passes of a rendered frame from `workers`/`name`, where the worker has written them
/// and may still write, into the new folder `attempt`, and removes the rest. Follows no link that a
/// worker could have put there; what is not a plain file of its own is an error (kRender), as is a
/// missing picture.
Status take_rendered(const std::filesystem::path& workers, const std::string& name,
                     const std::filesystem::path& attempt);

}  // namespace seedframe
