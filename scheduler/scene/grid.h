// Copies in rows.
#pragma once

#include <array>

#include "scene/compiled_config.h"

namespace seedframe {

/// A grid with its numbers known.
struct Grid {
  std::array<std::uint32_t, 3> counts = {1, 1, 1};
  Eigen::Vector3d spacing_m = Eigen::Vector3d::Zero();

  std::uint32_t size() const { return counts[0] * counts[1] * counts[2]; }
  /// From the grid's middle to a copy; x runs fastest. Metres.
  Eigen::Vector3d offset(std::uint32_t copy) const;
};

Grid evaluate_grid(const CompiledGrid& grid, std::uint32_t most, EvaluationContext& context);

}  // namespace seedframe
