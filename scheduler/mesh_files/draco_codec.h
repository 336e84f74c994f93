// Meshes as Draco streams: what an asset's mesh.drc holds.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

struct DracoOptions {
  int position_bits = 16;  ///< of the longest side of the bounding box: 1 mm of 65 m, 1 µm of 65 mm
  int uv_bits = 14;
};

/// Positions stay shared between the triangles around a vertex. Names of slots and the smoothing
/// angle are not part of the stream. Deterministic: one mesh, one stream.
Result<std::string> encode_draco(const Mesh& mesh, const DracoOptions& options = {});

/// Slots are named "slot0", "slot1", …; smooth_angle_rad is 0. A damaged stream is an error
/// (kCorrupt) that names `what`.
Result<Mesh> decode_draco(std::string_view bytes, const std::string& what);

}  // namespace seedframe
