// Puts the camera into the world, and its lens and its sensor into the frame spec.
#pragma once

#include "scene/compiled_config.h"
#include "scene/frame_draft.h"

namespace seedframe {

/// Returns world_from_camera. `config` says which section is the camera's parent.
Affine place_camera(const CompiledConfig& config, FrameDraft& draft, EvaluationContext& context);

/// Nothing where the config says nothing of a sensor.
void set_sensor(const std::optional<CompiledSensor>& sensor, FrameSpec& spec,
                EvaluationContext& context);

}  // namespace seedframe
