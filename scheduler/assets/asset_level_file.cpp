#include "assets/asset_level_file.h"

#include "base/files.h"
#include "base/portable_math.h"
#include "base/sha256.h"
#include "mesh_files/draco_codec.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

// The stream says how many slots it uses, asset.json how they are called.
Status name_slots(Mesh& mesh, const AssetDescription& description, const std::string& what) {
  if (description.slots.size() < mesh.slot_names.size()) {
    return fail(ErrorKind::kCorrupt, "{}: the mesh uses {} material slots, but {} are named", what,
                mesh.slot_names.size(), description.slots.size());
  }
  mesh.slot_names = description.slots;
  return {};
}

/// The bytes of a stored mesh: of its copy, if there is one that is whole.
Result<std::string> read_stored(const fs::path& file, const std::string& sha256,
                                const fs::path& copies) {
  if (copies.empty()) return read_file(file);
  const fs::path copy = copies / (sha256 + ".drc");
  std::error_code missing;
  if (fs::exists(copy, missing)) {
    Result<std::string> bytes = read_file(copy);
    if (bytes && sha256_hex(*bytes) == sha256) return bytes;
  }
  Result<std::string> bytes = read_file(file);
  // Without a copy the next one reads the file itself: slower, not wrong.
  if (bytes) (void)write_file_atomically(copy, *bytes);
  return bytes;
}

}  // namespace

Result<Mesh> read_level_mesh(const fs::path& folder, const AssetDescription& description,
                             std::size_t level, const fs::path& copies) {
  const LevelRecord& record = description.levels[level];
  const std::string what = (folder / record.file).string();
  const auto stream = read_stored(folder / record.file, record.sha256, copies);
  if (!stream) return forward_error(stream);
  const std::string sha256 = sha256_hex(*stream);
  if (sha256 != record.sha256) {
    return fail(ErrorKind::kCorrupt,
                "{} is damaged: its SHA-256 is {}, but {} says {}; import the asset again", what,
                sha256, asset_files::kDescription, record.sha256);
  }
  auto mesh = decode_draco(*stream, what);
  if (!mesh) return forward_error(mesh);
  if (Status status = name_slots(*mesh, description, what); !status) return forward_error(status);
  if (mesh->triangles.size() != record.triangles) {
    return fail(ErrorKind::kCorrupt, "{}: {} says {} triangles, but there are {}", what,
                asset_files::kDescription, record.triangles, mesh->triangles.size());
  }
  mesh->smooth_angle_rad = portable::radians(description.smooth_angle_deg);
  return mesh;
}

}  // namespace seedframe
