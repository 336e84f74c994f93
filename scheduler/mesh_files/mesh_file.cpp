#include "mesh_files/mesh_file.h"

#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "mesh_files/gltf_reader.h"
#include "mesh_files/mesh_builder.h"
#include "mesh_files/obj_reader.h"
#include "mesh_files/off_reader.h"
#include "mesh_files/ply_reader.h"
#include "mesh_files/stl_reader.h"
#include "mesh_files/text_scanner.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

using Position = Eigen::Vector3d;

struct Format {
  Result<FileMesh> (*read)(const fs::path& path);
  bool is_gltf = false;
};

// Before it is opened: a pipe would be waited for, a device read for ever.
Status check_is_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_regular_file(status)) return {};
  const char* found = !fs::exists(status)        ? "there is no such file"
                      : fs::is_directory(status) ? "it is a folder"
                                                 : "it is a device, a pipe or a socket";
  return fail(ErrorKind::kInput, "cannot read {}: {}", path.string(), found);
}

std::string beginning_of(const fs::path& path) {
  std::string start(512, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

// What a file begins with tells more than its name, where it tells anything.
std::string kind_of(const fs::path& path, std::string_view start) {
  if (start.starts_with("glTF")) return ".glb";
  const std::string_view text = without_byte_order_mark(start);
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return ".ply";
  std::string extension = path.extension().string();
  for (char& c : extension) c = lower_case(c);
  return extension;
}

Result<Format> format_of(const fs::path& path, std::string_view start) {
  const std::string kind = kind_of(path, start);
  if (kind == ".stl") return Format{read_stl};  // which may be binary, and begin with anything
  if (kind != ".glb" && is_utf16(start)) return fail_as_utf16(path.string());
  if (kind == ".obj") return Format{read_obj};
  if (kind == ".ply") return Format{read_ply};
  if (kind == ".off") return Format{read_off};
  if (kind == ".gltf" || kind == ".glb") return Format{read_gltf, true};
  return fail(ErrorKind::kInput,
              "{}: no reader for '{}': expected .obj, .ply, .stl, .off, .gltf or .glb",
              path.string(), kind);
}

// In metres, z up.
void turn_and_scale(std::vector<std::array<double, 3>>& positions, bool y_up, double scale) {
  for (auto& p : positions) {
    if (y_up) p = {p[0], -p[2], p[1]};
    for (double& value : p) value *= scale;
  }
}

// Strays would make a far part look large, and so what its coordinates lose look small.
std::vector<Position> used_positions(const FileMesh& file) {
  std::vector<bool> used(file.positions.size(), false);
  for (const auto& triangle : file.mesh.triangles) {
    for (const std::uint32_t vertex : triangle) used[vertex] = true;
  }
  std::vector<Position> positions;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto& p = file.positions[i];
    if (used[i]) positions.emplace_back(p[0], p[1], p[2]);
  }
  return positions;
}

// The farthest that rounding to floats moves one of the positions, as seen from `origin`.
double rounding(const std::vector<Position>& positions, const Position& origin) {
  double greatest = 0.0;
  for (const Position& p : positions) {
    const Position seen = p - origin;
    greatest = std::max(greatest, (seen - seen.cast<float>().cast<double>()).norm());
  }
  return greatest;
}

MeshFile placed(FileMesh file, const MeshFileOptions& options) {
  MeshFile out;
  const std::vector<Position> used = used_positions(file);
  Position low = used.front();
  Position high = used.front();
  for (const Position& p : used) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  out.rounding_m = rounding(used, out.origin_m);
  if (out.rounding_m > options.most_rounding * (high - low).maxCoeff()) {
    out.origin_m = 0.5 * (low + high);
    out.rounding_m = rounding(used, out.origin_m);
  }
  out.mesh = std::move(file.mesh);
  out.mesh.positions.reserve(file.positions.size());
  for (const auto& p : file.positions) {
    const Eigen::Vector3f seen = (Position(p[0], p[1], p[2]) - out.origin_m).cast<float>();
    out.mesh.positions.push_back({seen.x(), seen.y(), seen.z()});
  }
  out.spacing_m = file.spacing * options.scale;
  out.materials = std::move(file.materials);
  out.dropped = std::move(file.dropped);
  out.not_kept = std::move(file.not_kept);
  return out;
}

}  // namespace

Result<MeshFile> read_mesh_file(const fs::path& path, const MeshFileOptions& options) {
  if (Status is_file = check_is_file(path); !is_file) return forward_error(is_file);
  const std::string start = beginning_of(path);
  const auto format = format_of(path, start);
  if (!format) return forward_error(format);
  auto file = format->read(path);
  if (!file) return forward_error(file);
  const bool y_up = options.up.value_or(format->is_gltf ? UpAxis::kY : UpAxis::kZ) == UpAxis::kY;
  turn_and_scale(file->positions, y_up, options.scale);
  MeshFile mesh = placed(std::move(*file), options);
  mesh.has_unit = format->is_gltf;
  mesh.has_up = format->is_gltf;
  mesh.by_y_up_program = start.starts_with("# Blender");
  if (Status good = check_mesh(mesh.mesh, path.string()); !good) return forward_error(good);
  return mesh;
}

}  // namespace seedframe
