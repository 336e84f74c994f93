// What all readers of mesh files do with the polygons that they find.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

/// More are refused: levels of detail, exact distances and compression would take hours, and a
/// renderer spends half a second a frame on each million.
inline constexpr std::size_t kMostImportedTriangles = 4'000'000;
/// Cutting a polygon into triangles takes up to the cube of its corners.
inline constexpr std::size_t kMostPolygonCorners = 1024;
inline constexpr std::size_t kMostImportedSlots = 1u << 15;

/// A corner of a polygon: indices of its position and its UV, from 0.
struct PolygonCorner {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t position = kNone;
  std::uint32_t uv = kNone;  ///< kNone: UV (0, 0)
};

/// Collects polygons as triangles. Errors (kInput) begin with the file's name and the place that
/// the reader gives, "line 7" or "face 12".
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string file) : file_(std::move(file)) {}

  std::size_t position_count() const { return mesh_.positions.size(); }
  std::size_t uv_count() const { return uvs_.size(); }
  /// Its index. Coordinates are not looked at before finish().
  std::uint32_t add_position(const std::array<float, 3>& position);
  std::uint32_t add_uv(const std::array<float, 2>& uv);
  /// Polygons that follow are of this slot; "default" without one. A name that is not UTF-8 is
  /// taken for Latin-1.
  void use_slot(std::string_view name);
  /// Indices must be in range.
  Status add_polygon(std::span<const PolygonCorner> corners, const std::string& place);

  /// An error unless check_mesh finds nothing. `expected` says what polygons look like in the file.
  Result<Mesh> finish(const std::string& expected);

  template <class... Args>
  tl::unexpected<Error> fail_at(const std::string& place, fmt::format_string<Args...> format,
                                Args&&... args) const {
    return fail(ErrorKind::kInput, "{}{}{}: {}", file_, place.empty() ? "" : ":", place,
                fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  std::string file_;
  Mesh mesh_;
  std::vector<std::array<float, 2>> uvs_;
  std::map<std::string, std::uint32_t> slots_;
  std::uint32_t slot_ = 0;
  std::vector<Eigen::Vector3d> points_;  // of the polygon at hand
};

}  // namespace seedframe
