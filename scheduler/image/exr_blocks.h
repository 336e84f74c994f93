// The blocks of lines of an EXR file: whether they hold what the header says.
#pragma once

#include <string_view>

#include <OpenEXR/ImfHeader.h>

namespace seedframe {

/// OpenEXR takes what a block lacks from uninitialised memory, and returns it as pixels: one
/// damaged byte, a channel's type, is enough. So every block must unpack to the bytes of its lines.
/// `bytes` must be without exr_header_fault and exr_size_fault. Returns what is wrong, or null;
/// every compression but ZIP and run lengths is wrong.
const char* exr_block_fault(std::string_view bytes, const Imf::Header& header);

}  // namespace seedframe
