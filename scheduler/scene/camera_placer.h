// Puts the camera into the world, and its lens into the frame spec.
#pragma once

#include "scene/compiled_config.h"
#include "scene/frame_draft.h"

namespace seedframe {

/// Returns world_from_camera. `config` says which section is the camera's parent.
Affine place_camera(const CompiledConfig& config, FrameDraft& draft, EvaluationContext& context);

}  // namespace seedframe
