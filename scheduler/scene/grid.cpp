#include "scene/grid.h"

#include "scene/frame_draft.h"

namespace seedframe {

Eigen::Vector3d Grid::offset(std::uint32_t copy) const {
  const std::array<std::uint32_t, 3> index = {copy % counts[0], copy / counts[0] % counts[1],
                                              copy / counts[0] / counts[1]};
  Eigen::Vector3d offset;
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = 0.5 * (static_cast<double>(counts[i]) - 1.0);
    offset[static_cast<int>(i)] =
        (static_cast<double>(index[i]) - middle) * spacing_m[static_cast<int>(i)];
  }
  return offset;
}

Grid evaluate_grid(const CompiledGrid& grid, std::uint32_t most, EvaluationContext& context) {
  Grid result;
  std::uint64_t size = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    result.counts[i] = copies_of(grid.counts[i], most, context);
    size *= result.counts[i];
  }
  if (size > most) {
    context.report(grid.place, fmt::format("a grid may have {} copies, this has {}", most, size));
  }
  if (size == 0 || size > most) result.counts = {0, 1, 1};
  result.spacing_m = grid.spacing_m.evaluate(context);
  return result;
}

}  // namespace seedframe
