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
#include "mesh_files/color_slots.h"
#include "mesh_files/file_mesh.h"

namespace seedframe {

/// More are refused: levels of detail, exact distances and compression would take hours, and a
/// renderer spends half a second a frame on each million.
inline constexpr std::size_t kMostImportedTriangles = 4'000'000;
/// Cutting a polygon into triangles takes up to the cube of its corners.
inline constexpr std::size_t kMostPolygonCorners = 1024;
inline constexpr std::size_t kMostImportedSlots = 1u << 15;

/// For MeshBuilder::not_kept.
inline constexpr std::string_view kNormals =
    "normals (which edges are sharp is told by their angle)";

/// A corner of a polygon: indices of its position and its UV, from 0.
struct PolygonCorner {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t position = kNone;
  std::uint32_t uv = kNone;  ///< kNone: UV (0, 0)
  ColorCode color = kNoColor;
};

/// Collects polygons as triangles. Errors (kInput) begin with the file's name and the place that
/// the reader gives, "line 7" or "face 12".
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string file) : file_(std::move(file)) {}

  std::size_t position_count() const { return out_.positions.size(); }
  std::size_t uv_count() const { return uvs_.size(); }
  /// Its index. Coordinates are not looked at.
  std::uint32_t add_position(const std::array<double, 3>& position);
  /// Its index. One that no float can hold is dropped: (0, 0) stands for it.
  std::uint32_t add_uv(const std::array<double, 2>& uv, std::string_view place);
  /// What the slot of that name looks like in the file.
  void add_material(const std::string& slot, FileMaterial material);
  /// Polygons that follow are of this slot; "default" without one. A name that is not UTF-8 is
  /// taken for Latin-1.
  void use_slot(std::string_view name);
  /// Indices must be in range.
  Status add_polygon(std::span<const PolygonCorner> corners, const std::string& place);

  /// Something optional was wrong and is left out. `what` says what is done instead; how often it
  /// was, and where first, is added.
  void drop(std::string_view what, std::string_view place);
  /// Something that is not wrong, but that an asset has no place for. Said once.
  void not_kept(std::string_view what);
  /// A coordinate of the file is this 32-bit float.
  void stored_as(float coordinate);

  /// An error without polygons; `expected` says what polygons look like in the file.
  Result<FileMesh> finish(const std::string& expected);

  template <class... Args>
  tl::unexpected<Error> fail_at(const std::string& place, fmt::format_string<Args...> format,
                                Args&&... args) const {
    return fail(ErrorKind::kInput, "{}{}{}: {}", file_, place.empty() ? "" : ":", place,
                fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  struct Dropped {
    std::size_t count = 0;
    std::string first;
  };

  std::string file_;
  FileMesh out_;
  std::vector<std::array<float, 2>> uvs_;
  std::map<std::string, std::uint32_t> slots_;
  std::uint32_t slot_ = 0;
  std::vector<ColorCode> colors_;  ///< of each triangle
  std::map<std::string, Dropped, std::less<>> dropped_;
  float largest_ = 0.0f;                 // of stored_as
  std::vector<Eigen::Vector3d> points_;  // of the polygon at hand
};

/// Of a text file whose is_utf16 is true.
inline tl::unexpected<Error> fail_as_utf16(const std::string& file) {
  return fail(ErrorKind::kInput, "{} is text in UTF-16: save it as UTF-8, and import that", file);
}

}  // namespace seedframe
