// Values out of a mesh buffer (docs/formats/mesh-buffer.md), where they lie.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace seedframe {

/// Of bytes that mesh_from_buffer has read without an error, and that outlive it.
class MeshBufferView {
 public:
  MeshBufferView() = default;
  explicit MeshBufferView(std::string_view bytes) {
    constexpr std::size_t kCounts = 8, kPositions = 24;
    const auto vertices = value<std::uint32_t>(bytes.data() + kCounts, 0);
    const auto triangles = value<std::uint32_t>(bytes.data() + kCounts, 1);
    positions_ = bytes.data() + kPositions;
    triangles_ = positions_ + sizeof(Position) * vertices;
    corner_uvs_ = triangles_ + sizeof(Triangle) * triangles;
    slots_ = corner_uvs_ + sizeof(TriangleUvs) * triangles;
  }

  using Position = std::array<float, 3>;                    ///< object space, metres
  using Triangle = std::array<std::uint32_t, 3>;            ///< indices of positions
  using TriangleUvs = std::array<std::array<float, 2>, 3>;  ///< of its corners; v points up

  Position position(std::uint32_t index) const { return value<Position>(positions_, index); }
  Triangle triangle(std::uint32_t index) const { return value<Triangle>(triangles_, index); }
  TriangleUvs uvs(std::uint32_t triangle) const {
    return value<TriangleUvs>(corner_uvs_, triangle);
  }
  std::uint32_t slot(std::uint32_t triangle) const {
    return value<std::uint32_t>(slots_, triangle);
  }

 private:
  template <class T>
  static T value(const char* array, std::size_t index) {
    T value;
    std::memcpy(&value, array + index * sizeof(T), sizeof(T));  // nothing is aligned
    return value;
  }

  const char* positions_ = nullptr;
  const char* triangles_ = nullptr;
  const char* corner_uvs_ = nullptr;
  const char* slots_ = nullptr;
};

}  // namespace seedframe
