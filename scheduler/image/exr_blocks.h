// The blocks of lines of an EXR file: the pixels, read without OpenEXR.
#pragma once

#include <string_view>

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>

namespace seedframe {

/// Reads the channels for which `buffer` has a slice, all of which are of type FLOAT; half and
/// integer values are converted as OpenEXR converts them. Unlike OpenEXR it unpacks every block
/// once, and finds it damaged unless it holds exactly the bytes of its lines, whichever channels
/// are wanted. `bytes` must be without exr_header_fault and exr_size_fault. Returns what is wrong,
/// or null; every compression but ZIP and run lengths is wrong.
const char* read_exr_blocks(std::string_view bytes, const Imf::Header& header,
                            const Imf::FrameBuffer& buffer);

}  // namespace seedframe
