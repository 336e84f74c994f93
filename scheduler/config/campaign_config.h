// A campaign's config as typed values: what the YAML says, with nothing drawn or looked up yet.
// Every key is documented in docs/config.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/pixel_rect.h"
#include "config/values.h"
#include "spec/campaign_settings.h"

namespace seedframe {

inline constexpr long long kMostFrames = 100'000'000;  // of a campaign

/// How often something is drawn anew. A copy's own variables are drawn for each copy, once per
/// scene or once per frame.
enum class Level { kCampaign, kScene, kFrame };

struct VariableConfig {
  std::string name;
  Place place;
  std::variant<NumberSource, NameSource, VectorSource, ColorSource> source;
};

/// One axis of a sweep: points that are taken in turn, each of which sets one or more variables.
struct SweepAxis {
  std::string name;
  Place place;
  /// Every point sets the same variables, to numbers or to names.
  std::vector<std::map<std::string, std::variant<double, std::string>>> points;
};

/// The Cartesian product of all points of all axes; each scene takes one, the last axis fastest.
struct SweepConfig {
  std::vector<SweepAxis> axes;
  /// All else is drawn once for the whole product, so that its scenes differ in nothing else.
  bool hold_draws = true;
  Place place;

  /// Number of combinations; 1 without axes.
  std::int64_t size() const;
};

enum class ConstraintKind { kVisible, kInView, kPixels, kApart, kDistance };

/// What must hold in a frame; else its frame-level draws are made again.
struct ConstraintConfig {
  std::string name;
  Place place;
  ConstraintKind kind = ConstraintKind::kVisible;
  std::vector<std::string> objects;  ///< names of sections; empty: all objects
  /// kVisible, kInView: a share; kPixels: pixels; kApart, kDistance: metres.
  NumberSource at_least;
};

/// Only a part of each image is rendered.
struct RegionConfig {
  bool of_objects = false;       ///< what all instances with an id span
  std::optional<PixelRect> box;  ///< inside the image
};

/// Each frame is a picture of one object, cut out of the image and with a resolution of its own.
struct PatchConfig {
  int size = 32;                ///< of both sides, pixels
  double least_visible = 0.25;  ///< share of its silhouette that an object must show
  bool keep_shape = false;      ///< else it is stretched to fill the patch
  Place place;
};

struct RenderConfig {
  int width = 640;
  int height = 480;
  int samples = 64;
  AdaptiveSampling adaptive;
  Denoise denoise = Denoise::kOff;
  int max_bounces = 6;
  double filter_width_px = 1.5;
  double clamp_indirect = 10.0;
  RenderLevers levers;
  RegionConfig region;
  bool depth = false;
  bool normal = false;
  RenderDevice device = RenderDevice::kCpu;
  bool persistent_data = false;  ///< Cycles keeps scenes: pixels depend on earlier frames
  Place place;
};

struct LabelConfig {
  LabelSource source = LabelSource::kIndexPass;
  TwinCheck check;
  Place place;
};

struct ImageConfig {
  ImageSettings settings;
  std::optional<std::filesystem::path> ocio_config;  ///< none: Blender's own
  ImageEncoding encoding;
  Place place;
};

struct MaterialConfig {
  std::string name;
  Place place;
  ColorSource base_color;
  NumberSource metallic, roughness, specular, transmission, ior, clearcoat, texture_repeat;
  std::optional<NumberSource> texture_size_m;  ///< in place of texture_repeat
  std::optional<NameSource> textures;          ///< name of a texture set
};

/// Copies in rows: along x first, then y, then z, centred on the position.
struct GridConfig {
  Place place;
  std::array<NumberSource, 3> counts;
  VectorSource spacing_m;
};

/// Draws from the library: with probability `realistic_share` one of the realistic materials
/// (those with textures), else one of the parametric ones; within each kind, each as likely.
struct MaterialShareConfig {
  Place place;
  NumberSource realistic_share;
  std::optional<std::vector<std::string>> realistic;   ///< none: all of the library
  std::optional<std::vector<std::string>> parametric;  ///< none: all of the library
};
using MaterialSource = std::variant<NameSource, MaterialShareConfig>;

/// Dropped at random places on the ground so that the copies' footprints keep apart.
struct ScatterConfig {
  std::array<NumberSource, 2> x;  ///< least and most, metres
  std::array<NumberSource, 2> y;
  NumberSource gap_m;  ///< least distance between the bounding circles of two footprints
  bool pile = false;   ///< anywhere, and dropped onto what is there
  Place place;
};

/// A name, and where it stands.
struct PlacedName {
  std::string name;
  Place place;
};

struct ObjectConfig {
  std::string name;
  Place place;
  std::vector<VariableConfig> variables;  ///< drawn for each copy
  Level redraw = Level::kScene;
  NumberSource count;
  std::optional<GridConfig> grid;      ///< says the count, instead of `count`
  std::optional<NameSource> asset;     ///< none: a group, which only carries its `objects`
  std::optional<NameSource> category;  ///< none: the asset's own, or that of category_of_asset
  std::map<std::string, PlacedName> category_of_asset;
  MaterialSource material;
  bool material_of_parent = false;  ///< instead: that of the copy which this object is in
  bool has_material = false;        ///< false: no word of it; a group has none then
  std::map<std::string, MaterialSource> slots;  ///< by material slot, instead of `material`
  VectorSource scale;                           ///< along the object's own axes
  VectorSource rotation_deg;                    ///< Euler angles, applied about x, then y, then z
  bool random_rotation = false;                 ///< any, instead of rotation_deg
  std::optional<std::array<NumberSource, 4>> quaternion;  ///< w, x, y, z, instead of rotation_deg
  VectorSource position;                 ///< metres, in the parent; x right, y away, z up
  std::optional<ScatterConfig> scatter;  ///< replaces x and y of the position
  bool rest_on_ground = false;           ///< the lowest vertex is lifted to z of the position
  bool rest_stable = false;  ///< on a face of its hull that it can stand on, and so lifted
  HiddenFrom hidden_from;
  bool auto_detail = false;           ///< a coarser level of the asset where nobody could tell
  std::vector<ObjectConfig> objects;  ///< placed relative to each copy of this one
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
  VectorSource target;        ///< what it shines at
  bool target_below = false;  ///< straight down instead
  ColorSource color;
  std::optional<GridConfig> grid;  ///< says the count, instead of `count`
  /// One of the three is set: W of radiant flux (sun: W/m²), lumens, or (sun) lux.
  std::optional<NumberSource> power, lumens, lux;
  NumberSource radius_m, angle_deg, blend, width_m, height_m;
};

struct GroundConfig {
  Level redraw = Level::kScene;
  NumberSource width_m, depth_m;
  NumberSource curvature_per_m;  ///< at the centre: z = curvature · (x² + y²) / 2
  MaterialSource material;
  Place place;
};

struct WorldConfig {
  Level redraw = Level::kScene;
  ColorSource color;
  NumberSource strength;
  std::optional<NameSource> hdri;  ///< name of an environment map, multiplied by the colour
  NumberSource rotation_deg;       ///< of the environment map, about z
  int importance_map_px = 512;     ///< see WorldSpec
  Place place;
};

struct CameraConfig {
  Level redraw = Level::kFrame;
  Place place;
  std::vector<VariableConfig> variables;
  std::optional<NumberSource> fov_deg;  ///< horizontal
  std::vector<NumberSource> focal_px;   ///< one for both or fx, fy; empty: fov_deg is set
  std::optional<std::array<NumberSource, 2>> center_px;  ///< cx, cy; none: the image's middle
  /// Position and target are relative to the first copy of this object; none: to the world.
  std::optional<std::string> parent;
  /// None: the mean of the centres of all objects' bounding boxes.
  std::optional<VectorSource> target;
  /// Either a position, or a distance and angles around the target.
  std::optional<VectorSource> position;
  NumberSource distance_m, azimuth_deg, elevation_deg;
  NumberSource roll_deg;
  NumberSource clip_start_m, clip_end_m;
  NumberSource f_stop;           ///< 0: a pinhole
  NumberSource sensor_width_mm;  ///< with the focal length in pixels: the lens behind the f-stop
  std::optional<NumberSource> focus_distance_m;  ///< none: the distance to the target
};

/// Over the finished picture; see SensorSettings.
struct SensorConfig {
  Level redraw = Level::kFrame;
  NumberSource blur_px, exposure_stops, full_well, read_noise, jpeg_quality;
  ColorSource white_balance;  ///< of the light that becomes white
  Place place;
};

struct CampaignConfig {
  std::string name;
  std::uint64_t seed = 0;
  std::string stream;  ///< of the seed's draws; empty: the seed's own
  std::int64_t scenes = 1;
  std::int64_t frames_per_scene = 1;
  std::vector<std::string> categories;
  std::vector<std::filesystem::path> asset_folders;     ///< searched before the built-in ones
  std::vector<std::filesystem::path> material_folders;  ///< searched before the built-in ones
  RenderConfig render;
  Determinism determinism;
  ImageConfig image;
  LabelConfig labels;
  std::optional<QualityWish> quality;
  std::optional<PatchConfig> patches;
  std::vector<VariableConfig> campaign_variables, scene_variables, frame_variables;
  std::vector<MaterialConfig> materials;
  std::vector<ObjectConfig> objects;
  std::vector<LightConfig> lights;
  std::optional<GroundConfig> ground;
  WorldConfig world;
  CameraConfig camera;
  std::optional<SensorConfig> sensor;
  SweepConfig sweep;
  std::vector<ConstraintConfig> constraints;
  int max_attempts = 100;                       ///< to meet all constraints in a frame
  std::optional<std::filesystem::path> graphs;  ///< JSON lines of variables' values, one a frame
  std::vector<std::filesystem::path> files;     ///< that the config and its bases name, and folders

  std::int64_t frame_count() const { return scenes * frames_per_scene; }
  /// Keys all draws: `seed`, or in a stream 64 bits drawn from it by the stream's name.
  std::uint64_t draw_seed() const;
};

/// Reads a config's text. `file` is the path as the user gave it; relative paths inside start at
/// its folder. All that it names lies in that folder or in an allowed one. The error names every
/// mistake with file:line:column and the path of the key.
Result<CampaignConfig> read_campaign_config(const std::string& text,
                                            const std::filesystem::path& file,
                                            const std::vector<Override>& overrides = {},
                                            const AllowedFolders& allowed = {});

/// Reads a material library: a document whose only key `materials` is as in a campaign.
Result<std::vector<MaterialConfig>> read_material_library(const std::string& text,
                                                          const std::filesystem::path& file,
                                                          const AllowedFolders& allowed = {});

}  // namespace seedframe
