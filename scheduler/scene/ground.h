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

}  // namespace seedframe
