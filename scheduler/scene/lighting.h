// Lights and the world of a frame, as its camera sees them.
#pragma once

#include "scene/compiled_config.h"
#include "scene/frame_draft.h"
#include "scene/material_picker.h"

namespace seedframe {

/// Lumens of a source whose light has the luminance `luminance` (Rec.709 weights of its linear RGB)
/// as Blender's watts. 683 lm/W is the luminous efficacy that defines the candela (SI brochure, 9th
/// edition, 2.3.1), and a renderer's RGB is radiance whose Rec.709 luminance stands for V(λ).
double watts_from_lumens(double lumens, double luminance);

/// The same for a spot, whose lumens leave through its cone only: Blender's watts are those of the
/// point light that it is a part of, so they are larger by 4π over the cone's solid angle.
double spot_watts_from_lumens(double lumens, double luminance, double cone_rad);

void add_lights(const CompiledConfig& config, const Affine& world_from_camera, FrameDraft& draft,
                EvaluationContext& context);
void set_world(const CompiledWorld& world, const Affine& world_from_camera,
               const MaterialPicker& materials, FrameDraft& draft, EvaluationContext& context);

}  // namespace seedframe
