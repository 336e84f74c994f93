// A config whose formulas, draws and names are ready: what the expander evaluates frame by frame.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/campaign_config.h"
#include "scene/draw.h"
#include "scene/material_library.h"
#include "scene/variables.h"

namespace seedframe {

struct CompiledMaterial {
  Place place;
  ColorDraw base_color;
  NumberDraw metallic, roughness, specular, transmission, ior, clearcoat, texture_repeat;
  std::optional<NameDraw> textures;
};

/// The materials that one object (or the ground) may get, with draws of its own.
struct CompiledMaterials {
  NameDraw name;
  std::map<std::string, CompiledMaterial> by_name;
};

struct CompiledScatter {
  std::array<NumberDraw, 2> x, y;
  NumberDraw x_draw, y_draw;  ///< uniform over [0, 1]
  NumberDraw gap_m;
  Place place;
};

struct CompiledObject {
  std::string name;
  Place place;
  VariableBlock variables;
  NumberDraw count;
  NameDraw asset;
  std::optional<NameDraw> category;
  CompiledMaterials materials;
  NumberDraw scale;
  VectorDraw rotation_deg, position;
  std::optional<CompiledScatter> scatter;
  bool rest_on_ground = false;
};

struct CompiledLight {
  std::string name;
  Place place;
  LightType type = LightType::kPoint;
  VariableBlock variables;
  NumberDraw count;
  VectorDraw position, target;
  ColorDraw color;
  NumberDraw power, radius_m, angle_deg, blend, width_m, height_m;
};

struct CompiledGround {
  NumberDraw width_m, depth_m;
  CompiledMaterials materials;
  Place place;
};

struct CompiledCamera {
  Place place;
  VariableBlock variables;
  std::optional<NumberDraw> fov_deg, focal_px;
  std::optional<VectorDraw> target, position;
  NumberDraw distance_m, azimuth_deg, elevation_deg, roll_deg, clip_start_m, clip_end_m;
};

/// Values that every formula may use.
struct BuiltInValues {
  double* scene_index = nullptr;  ///< from 0
  double* frame_index = nullptr;  ///< within its scene, from 0
  double* copy_index = nullptr;   ///< of objects and lights, from 0
  double* copies = nullptr;       ///< their count
};

struct CompiledConfig {
  VariableValues values;  ///< must not move: formulas point into it
  BuiltInValues built_in;
  VariableBlock campaign_variables, scene_variables, frame_variables;
  std::vector<CompiledObject> objects;
  std::vector<CompiledLight> lights;
  std::optional<CompiledGround> ground;
  ColorDraw world_color;
  NumberDraw world_strength;
  CompiledCamera camera;
};

/// Fills `compiled` in place; mistakes go to `errors`.
void compile_config(const CampaignConfig& config, const MaterialLibrary& materials,
                    CompiledConfig& compiled, Diagnostics& errors);

}  // namespace seedframe
