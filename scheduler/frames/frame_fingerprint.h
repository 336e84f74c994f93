// Whether a finished frame has been touched, without reading it.
#pragma once

#include <filesystem>
#include <string>

namespace seedframe {

/// A hash over name, size and time of modification of the files in a folder, in order of names;
/// empty if the folder cannot be listed. A frame whose fingerprint is that of the day when it was
/// stored is believed; any other is read and compared with its manifest, as after copying a
/// campaign. Files that change without anybody writing them (a failing disk) are found by
/// `seedframe resume --verify` only.
std::string frame_fingerprint(const std::filesystem::path& folder);

}  // namespace seedframe
