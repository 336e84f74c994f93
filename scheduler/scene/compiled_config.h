// A config whose formulas, draws and names are ready: what the expander evaluates frame by frame.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/campaign_config.h"
#include "draws/color_draw.h"
#include "draws/name_draw.h"
#include "draws/variables.h"
#include "scene/material_library.h"

namespace seedframe {

struct CompiledMaterial {
  Place place;
  ColorDraw base_color;
  NumberDraw metallic, roughness, specular, transmission, ior, clearcoat, texture_repeat;
  std::optional<NumberDraw> texture_size_m;  ///< in place of texture_repeat
  std::optional<NameDraw> textures;
};

/// With probability `realistic_share` one of the realistic materials, else of the parametric.
struct CompiledShare {
  NumberDraw realistic_share;
  PhiloxStream stream;
  Level level = Level::kScene;
  std::vector<std::string> realistic, parametric;
};

/// As a material's name: what the asset's slots look like in the file that it was imported from.
inline constexpr std::string_view kOwnMaterial = "own";

/// The materials that one object (or slot, or the ground) may get, with draws of its own.
struct CompiledMaterials {
  std::string key;  ///< of the draw
  Place place;
  std::variant<NameDraw, CompiledShare> choice;
  std::map<std::string, CompiledMaterial> by_name;
  bool can_be_own = false;  ///< the choice may be kOwnMaterial, and no material is named so
};

struct CompiledGrid {
  Place place;
  std::array<NumberDraw, 3> counts;
  VectorDraw spacing_m;
};

struct CompiledScatter {
  std::array<NumberDraw, 2> x, y;
  NumberDraw x_draw, y_draw;  ///< uniform over [0, 1]
  NumberDraw gap_m;
  bool pile = false;
  NumberDraw falls;             ///< uniform over [0, 1]: the less, the earlier a piled copy falls
  Level level = Level::kScene;  ///< of the draws
  Place place;
};

struct CompiledObject {
  std::string name;
  std::size_t section = 0;  ///< numbers all objects, nested ones too
  Place place;
  VariableBlock variables;
  NumberDraw count;
  std::optional<CompiledGrid> grid;
  std::optional<NameDraw> asset;
  std::optional<NameDraw> category;
  std::map<std::string, PlacedName> category_of_asset;  ///< instead of category
  CompiledMaterials materials;
  bool material_of_parent = false;    ///< instead of `materials`
  bool material_for_objects = false;  ///< one of `objects` takes it
  std::map<std::string, CompiledMaterials> slots;
  VectorDraw scale, rotation_deg, position;
  std::optional<std::array<NumberDraw, 3>> random_rotation;  ///< uniform over [0, 1]
  std::optional<std::array<NumberDraw, 4>> quaternion;       ///< w, x, y, z
  std::optional<CompiledScatter> scatter;
  bool rest_on_ground = false;
  std::optional<NumberDraw> stable_face;  ///< uniform over [0, 1]: on which one it rests
  HiddenFrom hidden_from;
  bool auto_detail = false;
  std::vector<CompiledObject> objects;
};

struct CompiledLight {
  std::string name;
  Place place;
  LightType type = LightType::kPoint;
  VariableBlock variables;
  NumberDraw count;
  std::optional<CompiledGrid> grid;
  VectorDraw position, target;
  bool target_below = false;
  ColorDraw color;
  std::optional<NumberDraw> power, lumens, lux;
  NumberDraw radius_m, angle_deg, blend, width_m, height_m;
};

struct CompiledWorld {
  Place place;
  ColorDraw color;
  NumberDraw strength, rotation_deg;
  std::optional<NameDraw> hdri;
  int importance_map_px = 0;
};

struct CompiledGround {
  NumberDraw width_m, depth_m, curvature_per_m;
  CompiledMaterials materials;
  Place place;
};

struct CompiledCamera {
  Place place;
  VariableBlock variables;
  std::optional<NumberDraw> fov_deg;
  std::vector<NumberDraw> focal_px;  ///< one for both, or fx and fy; empty: by fov_deg
  std::optional<std::array<NumberDraw, 2>> center_px;
  std::optional<std::string> parent;
  std::optional<VectorDraw> target, position;
  NumberDraw distance_m, azimuth_deg, elevation_deg, roll_deg, clip_start_m, clip_end_m;
  NumberDraw f_stop, sensor_width_mm;
  std::optional<NumberDraw> focus_distance_m;
};

struct CompiledSensor {
  Place place;
  NumberDraw blur_px, exposure_stops, full_well, read_noise, jpeg_quality;
  ColorDraw white_balance;
  PhiloxStream seed;
};

struct CompiledConstraint {
  std::string name;
  Place place;
  ConstraintKind kind = ConstraintKind::kVisible;
  std::vector<std::size_t> sections;  ///< sorted; empty: all objects
  NumberDraw at_least;
};

/// The variables that one scene's combination of a sweep sets.
struct CompiledSweep {
  struct Variable {
    std::string name;
    std::size_t axis = 0;
    bool is_text = false;
    std::size_t slot = 0;
  };
  std::vector<Variable> variables;
};

/// Slots of the numbers that every formula may use.
struct BuiltInSlots {
  std::size_t scene_index = 0;  ///< from 0
  std::size_t frame_index = 0;  ///< within its scene, from 0
  std::size_t copy_index = 0;   ///< of objects and lights, from 0
  std::size_t copies = 0;       ///< their count
};

struct CompiledConfig {
  VariableTable variables;
  BuiltInSlots built_in;
  VariableBlock campaign_variables, scene_variables, frame_variables;
  std::vector<CompiledObject> objects;
  std::vector<CompiledLight> lights;
  std::optional<CompiledGround> ground;
  CompiledWorld world;
  CompiledCamera camera;
  std::optional<CompiledSensor> sensor;
  CompiledSweep sweep;
  std::vector<CompiledConstraint> constraints;
  std::size_t sections = 0;  ///< number of objects, nested ones too
};

/// Fills `compiled` in place; mistakes go to `errors`.
void compile_config(const CampaignConfig& config, const MaterialLibrary& materials,
                    CompiledConfig& compiled, Diagnostics& errors);

}  // namespace seedframe
