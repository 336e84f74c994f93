// One vertex for all corners of a file that lie at the same place.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>

#include "mesh_files/mesh_builder.h"

namespace seedframe {

/// For formats that store a position again for every triangle or every seam: without it no
/// triangle would know its neighbour. Positions are one when all their bits are (-0 is 0).
class PositionWelder {
 public:
  explicit PositionWelder(MeshBuilder& builder) : builder_(builder) {}

  /// The index of this position in the builder.
  std::uint32_t index_of(std::array<double, 3> position) {
    for (double& value : position) value += 0.0;  // -0 becomes 0
    const auto [entry, is_new] = known_.try_emplace(position, 0);
    if (is_new) entry->second = builder_.add_position(position);
    return entry->second;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::uint64_t hash = 0;
      for (const double value : p) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
      }
      return hash;
    }
  };
  // By bits, so that a NaN equals itself; check_mesh refuses it later.
  struct Same {
    bool operator()(const std::array<double, 3>& a, const std::array<double, 3>& b) const {
      return std::bit_cast<std::array<std::uint64_t, 3>>(a) ==
             std::bit_cast<std::array<std::uint64_t, 3>>(b);
    }
  };

  MeshBuilder& builder_;
  std::unordered_map<std::array<double, 3>, std::uint32_t, Hash, Same> known_;
};

}  // namespace seedframe
