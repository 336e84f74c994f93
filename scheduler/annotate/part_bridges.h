// The shortest bridges that join the separate parts of a mask.
#pragma once

#include <cstddef>
#include <cstdint>
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

struct WorthwhileParts {
  std::vector<bool> kept;  ///< by part; at least one
  std::int64_t left_out_px = 0;
};

/// Takes parts off the ends of the tree while one has fewer pixels than there are background pixels
/// under its bridge, and the box of the rest is still the mask's.
WorthwhileParts worthwhile_parts(const Boundary& boundary,
                                 const std::vector<std::size_t>& part_of_ring, std::size_t parts,
                                 const std::vector<PartBridge>& bridges);

}  // namespace seedframe
