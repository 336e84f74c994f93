// The versions of a mesh that an asset stores: compressed, ever coarser, each with a guaranteed
// error.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/mesh.h"

namespace seedframe {

struct LevelOptions {
  /// The longest side of the object's box spans at most this many pixels in the nearest view.
  double pixels = 1024.0;
  /// Coarser levels, at most; level k is for views of at most pixels / 4^k.
  int most_levels = 4;
  /// How far the mesh already is from what its errors are measured against (MeshFile::rounding_m).
  double rounding_m = 0.0;
  std::function<void(const std::string& step)> on_step = {};  ///< what is begun, if it is set
};

/// The error that may be seen: of a pixel.
inline constexpr double kPixelShare = 1.0 / 20.0;
/// A level that does not save this share of the triangles of the one before is left out.
inline constexpr double kLeastSaving = 0.2;

/// Meshes of more triangles get no coarser levels: the time to measure them grows from minutes to
/// hours.
inline constexpr std::size_t kMostSimplifiedTriangles = 1'000'000;

struct StoredLevel {
  std::string stream;  ///< Draco
  Mesh mesh;           ///< as it comes out of the stream
  int position_bits = 0;
  double pixels = 0.0;   ///< for views in which the longest side spans at most this many
  double bound_m = 0.0;  ///< 1/20 pixel of such a view
  /// Every point of the surface is within this of that of the mesh before, both ways: of the
  /// imported mesh (rounding_m included) for level 0, of level 0 for the others, measured after
  /// compression.
  double error_m = 0.0;
};

/// Level 0 is the mesh itself, compressed. error_m of level 0, and its sum with that of any other
/// level, is within the level's bound_m: a level for which no such mesh was found is left out. A
/// mesh that is not an oriented manifold, or larger than kMostSimplifiedTriangles, has no other
/// levels.
Result<std::vector<StoredLevel>> make_levels(const Mesh& mesh, const LevelOptions& options,
                                             const std::string& what);

}  // namespace seedframe
