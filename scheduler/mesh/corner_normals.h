// Shading normals as Blender makes them from a mesh and a smoothing angle.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace seedframe {

/// Three unit normals per triangle, one for each corner. Around a vertex, triangles that are joined
/// by edges no sharper than the angle share one normal: the mean of their normals, each weighted by
/// its angle at the vertex (Thürmer and Wüthrich, "Computing vertex normals from polygonal facets",
/// 1998). An edge of one, or of more than two triangles, is sharp, as is one whose triangles run in
/// opposite senses. With an angle of 0 every corner has its triangle's own normal. Zero for a
/// corner whose triangles have no area.
std::vector<std::array<float, 3>> corner_normals(
    std::span<const std::array<float, 3>> positions,
    std::span<const std::array<std::uint32_t, 3>> triangles, double smooth_angle_rad);

}  // namespace seedframe
