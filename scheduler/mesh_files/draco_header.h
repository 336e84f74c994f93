// The header of a Draco stream, checked before Draco trusts it.
#pragma once

#include <string_view>

namespace seedframe {

/// Draco allocates memory for as many vertices and triangles as the header claims, up to 2 GB for a
/// few bytes. Returns what is wrong with a stream that is not as docs/formats/asset.md says
/// (bitstream 2.2, edgebreaker), or that claims more than its bytes can hold; or null.
const char* draco_header_fault(std::string_view bytes);

}  // namespace seedframe
