// The bytes in which a mesh travels to a worker (docs/formats/mesh-buffer.md); their SHA-256 is the
// mesh's identity in every frame spec.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

/// By SHA-256.
using MeshBuffers = std::map<std::string, std::shared_ptr<const std::string>>;

/// The mesh must pass check_mesh. Names of slots are not part of the bytes.
std::string mesh_buffer(const Mesh& mesh);

/// Slots are named "slot0", "slot1", … Any other length than the header tells is an error
/// (kCorrupt) that names `what`, as is a mesh that check_mesh refuses.
Result<Mesh> mesh_from_buffer(std::string_view bytes, const std::string& what);

}  // namespace seedframe
