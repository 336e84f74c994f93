#include "mesh_files/mesh_builder.h"

#include "base/utf8.h"
#include "mesh_files/triangulate.h"

namespace seedframe {

std::uint32_t MeshBuilder::add_position(const std::array<float, 3>& position) {
  mesh_.positions.push_back(position);
  return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
}

std::uint32_t MeshBuilder::add_uv(const std::array<float, 2>& uv) {
  uvs_.push_back(uv);
  return static_cast<std::uint32_t>(uvs_.size() - 1);
}

void MeshBuilder::use_slot(std::string_view name) {
  const auto [slot, is_new] =
      slots_.emplace(as_utf8(name), static_cast<std::uint32_t>(slots_.size()));
  if (is_new) mesh_.slot_names.push_back(slot->first);
  slot_ = slot->second;
}

Status MeshBuilder::add_polygon(std::span<const PolygonCorner> corners, const std::string& place) {
  if (corners.size() < 3) {
    return fail_at(place, "a polygon needs 3 corners or more, found {}", corners.size());
  }
  if (corners.size() > kMostPolygonCorners) {
    return fail_at(place, "a polygon of {} corners is more than {}: cut it into smaller ones",
                   corners.size(), kMostPolygonCorners);
  }
  if (mesh_.triangles.size() + corners.size() - 2 > kMostImportedTriangles) {
    return fail_at(place, "more than {} triangles: simplify the mesh before it is imported",
                   kMostImportedTriangles);
  }
  if (mesh_.slot_names.size() > kMostImportedSlots) {
    return fail_at(place, "more than {} material slots", kMostImportedSlots);
  }
  if (mesh_.slot_names.empty()) use_slot("default");
  points_.clear();
  for (const PolygonCorner& corner : corners) {
    const auto& p = mesh_.positions[corner.position];
    points_.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto& triangle : triangulate(points_)) {
    mesh_.triangles.push_back({corners[triangle[0]].position, corners[triangle[1]].position,
                               corners[triangle[2]].position});
    mesh_.triangle_slots.push_back(slot_);
    for (const std::size_t corner : triangle) {
      const std::uint32_t uv = corners[corner].uv;
      mesh_.corner_uvs.push_back(uv == PolygonCorner::kNone ? std::array<float, 2>{} : uvs_[uv]);
    }
  }
  return {};
}

Result<Mesh> MeshBuilder::finish(const std::string& expected) {
  if (mesh_.triangles.empty()) {
    return fail(ErrorKind::kInput, "{} has no polygons: expected {}", file_, expected);
  }
  if (Status status = check_mesh(mesh_, file_); !status) return forward_error(status);
  return std::move(mesh_);
}

}  // namespace seedframe
