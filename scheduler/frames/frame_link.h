// A committed frame taken over from where it lies already.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "frames/manifest.h"

namespace seedframe {

/// Hard links, or copies on another file system, of a committed frame's files into `folder`, which
/// exists and is empty. All of them are read and compared with their manifest first; an error says
/// what is wrong, and nothing is there then.
Result<Manifest> link_frame(const std::filesystem::path& committed, const std::string& frame_id,
                            const std::filesystem::path& folder);

}  // namespace seedframe
