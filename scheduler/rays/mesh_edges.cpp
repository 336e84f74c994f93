#include "rays/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace seedframe {
namespace {

/// For each vertex the first of those at its place.
std::vector<std::uint32_t> first_at_place(std::span<const std::array<float, 3>> positions) {
  std::vector<std::uint32_t> by_place(positions.size());
  std::iota(by_place.begin(), by_place.end(), 0U);
  std::sort(by_place.begin(), by_place.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(positions[a], a) < std::tie(positions[b], b);
  });
  std::vector<std::uint32_t> first(positions.size());
  for (std::size_t i = 0; i < by_place.size(); ++i) {
    const bool same = i > 0 && positions[by_place[i]] == positions[by_place[i - 1]];
    first[by_place[i]] = same ? first[by_place[i - 1]] : by_place[i];
  }
  return first;
}

/// A side of a triangle; those of one edge are neighbours when sorted, upwards ones before the
/// others.
struct TriangleSide {
  std::uint32_t low = 0, high = 0;  ///< vertices
  bool downwards = false;           ///< from high to low
  std::uint32_t triangle = 0;

  bool operator<(const TriangleSide& other) const {
    return std::tie(low, high, downwards, triangle) <
           std::tie(other.low, other.high, other.downwards, other.triangle);
  }
};

}  // namespace

std::vector<MeshEdge> edges_of_closed_mesh(
    std::span<const std::array<float, 3>> positions,
    std::span<const std::array<std::uint32_t, 3>> triangles) {
  const std::vector<std::uint32_t> first = first_at_place(positions);
  std::vector<TriangleSide> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = first[triangles[t][i]];
      const std::uint32_t to = first[triangles[t][i == 2 ? 0 : i + 1]];
      if (from == to) continue;
      sides.push_back(
          {std::min(from, to), std::max(from, to), from > to, static_cast<std::uint32_t>(t)});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<MeshEdge> edges;
  edges.reserve(sides.size() / 2);
  for (auto begin = sides.begin(); begin != sides.end();) {
    const auto end = std::find_if(begin, sides.end(), [&](const TriangleSide& side) {
      return side.low != begin->low || side.high != begin->high;
    });
    const auto down =
        std::find_if(begin, end, [](const TriangleSide& side) { return side.downwards; });
    if (down - begin != end - down) return {};
    for (auto up = begin; up != down; ++up) {
      edges.push_back({up->low, up->high, up->triangle, (down + (up - begin))->triangle});
    }
    begin = end;
  }
  return edges;
}

}  // namespace seedframe
