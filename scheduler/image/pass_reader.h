// Reads the multilayer EXR that a worker wrote, and trusts nothing in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/error.h"
#include "image/image.h"

namespace seedframe {

/// What the file must hold to be the frame that was asked for.
struct PassExpectation {
  int width = 0;
  int height = 0;
  bool depth = false;
  bool normal = false;
  int max_instance_id = 0;    ///< a larger index is an error
  std::string frame_id = {};  ///< in the header's "Note"; empty: whatever is there
  bool sample_counts = false;
};

struct FramePasses {
  Image<float> combined;               ///< RGBA, scene-linear Rec.709, premultiplied alpha
  Image<std::uint16_t> instance_ids;   ///< 0 is background
  std::optional<Image<float>> depth;   ///< planar, metres along the viewing axis
  std::optional<Image<float>> normal;  ///< x, y, z in the camera's frame
  /// Samples of a pixel over those of the pixel that had most; is of the rendering, not of the
  /// frame, and has no hash.
  std::optional<Image<float>> sample_shares;
  /// SHA-256 of each pass's pixels by name ("combined", "index", "depth", "normal"): see
  /// pixel_hash.h.
  std::map<std::string, std::string> pixel_hashes;
};

/// Passes are found by the end of their channels' names, whatever the view layer is called.
/// kRender errors: another frame's file, a missing, cut or damaged file, a missing layer or two
/// that could be meant, another size, another compression than ZIP or run lengths, NaN or infinite
/// values (the depth of the background is a number, 1e10 in Blender), an index that is fractional,
/// negative or above max_instance_id. Each names the file, the pass and the first bad pixel. A
/// header that claims too much is refused before memory is allocated for it.
Result<FramePasses> read_passes(const std::filesystem::path& path, const PassExpectation& expected);

}  // namespace seedframe
