// A picture of a mesh for people who look for an asset.
#pragma once

#include <cstdint>
#include <string>

#include "image/image.h"
#include "mesh/mesh.h"

namespace seedframe {

/// A square RGB picture, sRGB, of the mesh from the front, right and above, shaded grey on white
/// with each material slot in a tint of its own. The same bytes for the same mesh. Throws
/// std::bad_alloc.
Image<std::uint8_t> thumbnail(const Mesh& mesh, int side_px);

/// The thumbnail.png of an asset: the bytes of a PNG file.
std::string thumbnail_png(const Mesh& mesh);

}  // namespace seedframe
