// Meshes that are hard in themselves.
#pragma once

#include <cstdint>

#include "mesh/mesh.h"

namespace seedframe {

/// From a point to the rim of a disc of 1 m radius, each triangle a thousandth as wide as long.
Mesh needles();

/// Every second, third, … `of` of the strips of a floor of 400 of them, from the `first` on, each
/// 2 mm wide and `aspect` times as long: they run away from the origin along -z, two triangles
/// each.
Mesh strips(std::uint32_t first, std::uint32_t of, double aspect);

/// Every triangle of a cube twice, once in each sense.
Mesh double_sided_cube();

/// A square of 2 m, facing z.
Mesh square();

}  // namespace seedframe
