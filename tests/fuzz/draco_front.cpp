#include "mesh/mesh_buffer.h"
#include "mesh_files/draco_codec.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace seedframe {

void fuzz_draco_front(std::string_view bytes) {
  const bool draco = bytes.starts_with("DRACO");
  const auto mesh = draco ? decode_draco(bytes, "mesh.drc") : mesh_from_buffer(bytes, "mesh.buf");
  if (!mesh) {
    promise(mesh.error().kind == ErrorKind::kCorrupt, "a damaged mesh is something that we wrote");
    return;
  }
  promise(check_mesh(*mesh, "mesh").has_value(), "what is read is a mesh");
  const std::string buffer = mesh_buffer(*mesh);
  promise(draco || buffer == bytes, "a mesh has one buffer");
  const auto again = mesh_from_buffer(buffer, "mesh.buf");
  promise(again.has_value(), "a mesh that was written can be read");
  promise(mesh_buffer(*again) == buffer, "writing and reading change no mesh");
}

}  // namespace seedframe
