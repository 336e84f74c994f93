// The shortest bridges that join the separate parts of a mask.
#pragma once

#include <cstddef>
#include <vector>

#include "annotate/boundary.h"

namespace seedframe {

/// From a crack of one part to a crack of another.
struct PartBridge {
  std::size_t from_crack = 0;
  std::size_t to_crack = 0;
};

/// parts - 1 bridges that make one tree of all parts and are together as short as possible,
/// measured in background pixels under a line between the pixels of the two cracks. `part_of_ring`
/// numbers the parts from 0.
std::vector<PartBridge> bridge_parts(const Mask& mask, const Boundary& boundary,
                                     const std::vector<std::size_t>& part_of_ring,
                                     std::size_t parts);

}  // namespace seedframe
