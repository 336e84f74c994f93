#include "mesh_files/mesh_builder.h"

#include <algorithm>
#include <cmath>

#include "base/utf8.h"
#include "mesh_files/triangulate.h"

namespace seedframe {

std::uint32_t MeshBuilder::add_position(const std::array<double, 3>& position) {
  out_.positions.push_back(position);
  return static_cast<std::uint32_t>(out_.positions.size() - 1);
}

std::uint32_t MeshBuilder::add_uv(const std::array<double, 2>& uv, std::string_view place) {
  constexpr double kMost = std::numeric_limits<float>::max();
  const bool usable = std::abs(uv[0]) <= kMost && std::abs(uv[1]) <= kMost;  // NaN is not
  if (!usable) drop("UVs that are not finite numbers are (0, 0) instead", place);
  uvs_.push_back(usable ? std::array{static_cast<float>(uv[0]), static_cast<float>(uv[1])}
                        : std::array{0.0f, 0.0f});
  return static_cast<std::uint32_t>(uvs_.size() - 1);
}

void MeshBuilder::use_slot(std::string_view name) {
  const auto [slot, is_new] =
      slots_.emplace(as_utf8(name), static_cast<std::uint32_t>(slots_.size()));
  if (is_new) out_.mesh.slot_names.push_back(slot->first);
  slot_ = slot->second;
}

void MeshBuilder::add_material(const std::string& slot, FileMaterial material) {
  out_.materials.insert_or_assign(slot, std::move(material));
}

Status MeshBuilder::add_polygon(std::span<const PolygonCorner> corners, const std::string& place) {
  Mesh& mesh = out_.mesh;
  if (corners.size() < 3) {
    return fail_at(place, "a polygon needs 3 corners or more, found {}", corners.size());
  }
  if (corners.size() > kMostPolygonCorners) {
    return fail_at(place, "a polygon of {} corners is more than {}: cut it into smaller ones",
                   corners.size(), kMostPolygonCorners);
  }
  if (mesh.triangles.size() + corners.size() - 2 > kMostImportedTriangles) {
    return fail_at(place, "more than {} triangles: simplify the mesh before it is imported",
                   kMostImportedTriangles);
  }
  if (mesh.slot_names.size() > kMostImportedSlots) {
    return fail_at(place, "more than {} material slots", kMostImportedSlots);
  }
  if (mesh.slot_names.empty()) use_slot("default");
  points_.clear();
  for (const PolygonCorner& corner : corners) {
    const auto& p = out_.positions[corner.position];
    points_.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto& triangle : triangulate(points_)) {
    mesh.triangles.push_back({corners[triangle[0]].position, corners[triangle[1]].position,
                              corners[triangle[2]].position});
    mesh.triangle_slots.push_back(slot_);
    colors_.push_back(color_of_triangle(
        {corners[triangle[0]].color, corners[triangle[1]].color, corners[triangle[2]].color}));
    for (const std::size_t corner : triangle) {
      const std::uint32_t uv = corners[corner].uv;
      mesh.corner_uvs.push_back(uv == PolygonCorner::kNone ? std::array<float, 2>{} : uvs_[uv]);
    }
  }
  return {};
}

void MeshBuilder::drop(std::string_view what, std::string_view place) {
  auto found = dropped_.find(what);
  if (found == dropped_.end()) {
    found = dropped_.emplace(what, Dropped{.count = 0, .first = std::string(place)}).first;
  }
  ++found->second.count;
}

void MeshBuilder::not_kept(std::string_view what) {
  std::vector<std::string>& list = out_.not_kept;
  constexpr std::size_t kMost = 20;
  if (list.size() < kMost && std::find(list.begin(), list.end(), what) == list.end()) {
    list.emplace_back(what);
  }
}

void MeshBuilder::stored_as(float coordinate) {
  if (std::isfinite(coordinate)) largest_ = std::max(largest_, std::abs(coordinate));
}

Result<FileMesh> MeshBuilder::finish(const std::string& expected) {
  if (out_.mesh.triangles.empty()) {
    return fail(ErrorKind::kInput, "{} has no polygons: expected {}", file_, expected);
  }
  if (!give_colors_slots(colors_, out_)) {
    not_kept(fmt::format("colours of vertices and faces (more than {} different ones)",
                         kMostColorSlots));
  }
  for (const auto& [what, dropped] : dropped_) {
    out_.dropped.push_back(dropped.count == 1 ? fmt::format("{}: at {}", what, dropped.first)
                                              : fmt::format("{}: {} of them, the first at {}", what,
                                                            dropped.count, dropped.first));
  }
  const float next = std::nextafter(largest_, std::numeric_limits<float>::infinity());
  out_.spacing = largest_ > 0.0f ? static_cast<double>(next) - static_cast<double>(largest_) : 0.0;
  return std::move(out_);
}

}  // namespace seedframe
