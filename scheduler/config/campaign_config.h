// A campaign's config as typed values: what the YAML says, with nothing drawn or looked up yet.
// Every key is documented in docs/config.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/values.h"

namespace seedframe {

/// How often something is drawn anew. A copy's own variables are drawn for each copy, once per
/// scene or once per frame.
enum class Level { kCampaign, kScene, kFrame };

struct VariableConfig {
  std::string name;
  Place place;
  std::variant<NumberSource, NameSource> source;
};

struct RenderConfig {
  int width = 640;
  int height = 480;
  int samples = 64;
  int max_bounces = 6;
  double filter_width_px = 1.5;
  double clamp_indirect = 10.0;
  bool depth = false;
  bool normal = false;
};

struct ImageConfig {
  std::string display = "sRGB";
  std::string view = "Filmic";
  std::string look = "None";
  double exposure_stops = 0.0;
  double gamma = 1.0;
  std::optional<std::filesystem::path> ocio_config;  ///< none: Blender's own
  Place place;
};

struct MaterialConfig {
  std::string name;
  Place place;
  ColorSource base_color;
  NumberSource metallic, roughness, specular, transmission, ior, clearcoat, texture_repeat;
  std::optional<NameSource> textures;  ///< name of a texture set
};

/// Dropped at random places on the ground so that the copies' footprints keep apart.
struct ScatterConfig {
  std::array<NumberSource, 2> x;  ///< least and most, metres
  std::array<NumberSource, 2> y;
  NumberSource gap_m;  ///< least distance between the bounding circles of two footprints
  Place place;
};

struct ObjectConfig {
  std::string name;
  Place place;
  std::vector<VariableConfig> variables;  ///< drawn for each copy
  Level redraw = Level::kScene;
  NumberSource count;
  NameSource asset;
  std::optional<NameSource> category;  ///< none: the asset's own
  NameSource material;
  NumberSource scale;
  VectorSource rotation_deg;             ///< Euler angles, applied about x, then y, then z
  VectorSource position;                 ///< metres, world; x right, y away, z up
  std::optional<ScatterConfig> scatter;  ///< replaces x and y of the position
  bool rest_on_ground = false;           ///< the lowest vertex is lifted to z of the position
};

enum class LightType { kPoint, kSun, kSpot, kArea };

struct LightConfig {
  std::string name;
  Place place;
  LightType type = LightType::kPoint;
  std::vector<VariableConfig> variables;
  Level redraw = Level::kScene;
  NumberSource count;
  VectorSource position;
  VectorSource target;  ///< what it shines at
  ColorSource color;
  NumberSource power;  ///< W of radiant flux; sun: W/m²
  NumberSource radius_m, angle_deg, blend, width_m, height_m;
};

struct GroundConfig {
  Level redraw = Level::kScene;
  NumberSource width_m, depth_m;
  NameSource material;
  Place place;
};

struct WorldConfig {
  Level redraw = Level::kScene;
  ColorSource color;
  NumberSource strength;
};

struct CameraConfig {
  Level redraw = Level::kFrame;
  Place place;
  std::vector<VariableConfig> variables;
  std::optional<NumberSource> fov_deg;   ///< horizontal
  std::optional<NumberSource> focal_px;  ///< one of the two is set
  /// None: the mean of the centres of all objects' bounding boxes.
  std::optional<VectorSource> target;
  /// Either a position, or a distance and angles around the target.
  std::optional<VectorSource> position;
  NumberSource distance_m, azimuth_deg, elevation_deg;
  NumberSource roll_deg;
  NumberSource clip_start_m, clip_end_m;
};

struct CampaignConfig {
  std::string name;
  std::uint64_t seed = 0;
  std::int64_t scenes = 1;
  std::int64_t frames_per_scene = 1;
  std::vector<std::string> categories;
  std::vector<std::filesystem::path> asset_folders;     ///< searched before the built-in ones
  std::vector<std::filesystem::path> material_folders;  ///< searched before the built-in ones
  RenderConfig render;
  ImageConfig image;
  std::vector<VariableConfig> campaign_variables, scene_variables, frame_variables;
  std::vector<MaterialConfig> materials;
  std::vector<ObjectConfig> objects;
  std::vector<LightConfig> lights;
  std::optional<GroundConfig> ground;
  WorldConfig world;
  CameraConfig camera;

  std::int64_t frame_count() const { return scenes * frames_per_scene; }
};

/// Reads a config's text. `file` is the path as the user gave it; relative paths inside start at
/// its folder. The error names every mistake with file:line:column and the path of the key.
Result<CampaignConfig> read_campaign_config(const std::string& text,
                                            const std::filesystem::path& file,
                                            const std::vector<Override>& overrides = {});

/// Reads a material library: a document whose only key `materials` is as in a campaign.
Result<std::vector<MaterialConfig>> read_material_library(const std::string& text,
                                                          const std::filesystem::path& file);

}  // namespace seedframe
