// Takes out of an EXR what would make two renders of one frame differ as files.
#pragma once

#include <filesystem>

#include "base/error.h"

namespace seedframe {

/// Copies an EXR, its compressed pixels untouched, without the attributes in which Blender and
/// Cycles note dates, times and hosts; keeps only what OpenEXR itself asks for. Does not force
/// the copy to the disk. kRender errors: a file that OpenEXR cannot read.
Status copy_without_metadata(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace seedframe
