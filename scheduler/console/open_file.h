// A file shown to whoever sits before the screen.
#pragma once

#include <filesystem>

namespace seedframe {

/// Has the desktop open a file (xdg-open), and goes on at once; where there is no screen, or
/// nothing that opens files, says so on standard error.
void open_file(const std::filesystem::path& file);

}  // namespace seedframe
