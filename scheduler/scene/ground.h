// The ground of a frame.
#pragma once

#include <array>
#include <string>

#include "base/last_made.h"
#include "scene/frame_draft.h"
#include "scene/material_picker.h"

namespace seedframe {

/// Safe to use from several threads.
class GroundMaker {
 public:
  /// Adds the ground to the draft, as an instance without an id.
  void add(const CompiledGround& ground, const MaterialPicker& materials, FrameDraft& draft,
           EvaluationContext& context);

 private:
  using Shape = std::array<double, 3>;  ///< width, depth, curvature
  struct GroundMesh {
    std::string sha256;  ///< of the buffer
    std::string buffer;
  };
  LastMade<Shape, GroundMesh> last_;
};

inline constexpr double kFlushGroundDropM = 1e-4;

/// Where a face of an object lies in the plane of a level ground and could be seen there — a table
/// top at z = 0, a sheet on the floor — neither would be seen before the other: the ground gives
/// way, by 0.1 mm. Undersides of what stands on it are hidden, and change nothing.
void lower_flush_ground(FrameDraft& draft);

}  // namespace seedframe
