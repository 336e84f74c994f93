#include "mesh_files/mesh_file.h"

#include <cctype>
#include <fstream>
#include <string>

#include "mesh_files/gltf_reader.h"
#include "mesh_files/obj_reader.h"
#include "mesh_files/off_reader.h"
#include "mesh_files/ply_reader.h"
#include "mesh_files/stl_reader.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

struct Format {
  Result<Mesh> (*read)(const fs::path& path);
  UpAxis up = UpAxis::kZ;
};

// What a file begins with tells more than its name, where it tells anything.
std::string kind_of(const fs::path& path) {
  std::string start(4, '\0');
  std::ifstream(path, std::ios::binary).read(start.data(), 4);
  if (start == "glTF") return ".glb";
  if (start.starts_with("ply") && (start[3] == '\n' || start[3] == '\r')) return ".ply";
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

Result<Format> format_of(const fs::path& path) {
  const std::string kind = kind_of(path);
  if (kind == ".obj") return Format{read_obj};
  if (kind == ".ply") return Format{read_ply};
  if (kind == ".stl") return Format{read_stl};
  if (kind == ".off") return Format{read_off};
  if (kind == ".gltf" || kind == ".glb") return Format{read_gltf, UpAxis::kY};
  return fail(ErrorKind::kInput,
              "{}: no reader for '{}': expected .obj, .ply, .stl, .off, .gltf or .glb",
              path.string(), kind);
}

}  // namespace

Result<Mesh> read_mesh_file(const fs::path& path, std::optional<UpAxis> up) {
  const auto format = format_of(path);
  if (!format) return forward_error(format);
  auto mesh = format->read(path);
  if (!mesh || up.value_or(format->up) == UpAxis::kZ) return mesh;
  for (auto& p : mesh->positions) p = {p[0], -p[2], p[1]};
  return mesh;
}

}  // namespace seedframe
