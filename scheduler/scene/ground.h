// The ground of a frame.
#pragma once

#include <array>

#include "scene/frame_draft.h"
#include "scene/material_picker.h"

namespace seedframe {

class GroundMaker {
 public:
  /// Adds the ground to the draft, as an instance without an id.
  void add(const CompiledGround& ground, MaterialPicker& materials, FrameDraft& draft,
           EvaluationContext& context);

 private:
  // The mesh of the last frame, which is often that of the next.
  std::array<double, 3> shape_ = {-1, -1, -1};  ///< width, depth, curvature
  std::string sha256_;
  std::shared_ptr<const std::string> buffer_;
};

}  // namespace seedframe
