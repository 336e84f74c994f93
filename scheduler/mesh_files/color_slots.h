// Colours of a file's vertices and faces as material slots.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "mesh_files/file_mesh.h"

namespace seedframe {

/// 0xrrggbb, codes of sRGB.
using ColorCode = std::uint32_t;
inline constexpr ColorCode kNoColor = std::numeric_limits<ColorCode>::max();

/// More than these are a picture, and no material slots.
inline constexpr std::size_t kMostColorSlots = 64;

/// Values from 0 to 1, others are clamped; kNoColor for one that is not a number.
ColorCode code_of_srgb(const std::array<double, 3>& srgb);
ColorCode code_of_linear(const std::array<double, 3>& linear);

/// Of the corners of a triangle: what two of them have, or else the first one's.
ColorCode color_of_triangle(const std::array<ColorCode, 3>& corners);

/// Gives the triangles of each colour a slot of their own, named after the slot that they had and
/// the colour ("bolt_ff0000", or "ff0000" for "default"), whose material is that of the slot, its
/// base colour multiplied. Triangles without a colour keep their slot, and so do white ones of a
/// slot with a material. `colors` is of each triangle. False, and nothing is changed, if there are
/// too many.
bool give_colors_slots(const std::vector<ColorCode>& colors, FileMesh& file);

}  // namespace seedframe
