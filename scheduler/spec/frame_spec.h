// The frame spec: one fully resolved frame, numbers only, relative to the camera.
// Its JSON is docs/formats/frame-spec.md; the SHA-256 of its canonical JSON is the frame id.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "base/pixel_rect.h"
#include "spec/image_settings.h"
#include "spec/keypoint.h"
#include "spec/sensor_settings.h"

namespace seedframe {

/// The newest. A frame is of the oldest version that has all that it needs, and so keeps its id.
inline constexpr int kFrameSpecVersion = 8;
inline constexpr int kOldestFrameSpecVersion = 5;

/// Linear RGB, Rec.709 primaries.
using Rgb = std::array<double, 3>;
/// Row-major when written; maps points of an object to the camera's frame (x right, y up, z towards
/// the viewer; metres). Includes scale.
using Affine = Eigen::Transform<double, 3, Eigen::Affine>;

/// A pixel is finished once its error is estimated to be below the threshold (Cycles' measure), but
/// not before min_samples. Threshold 0: every pixel has all samples.
struct AdaptiveSampling {
  double threshold = 0.0;
  int min_samples = 0;

  bool operator==(const AdaptiveSampling&) const = default;
};

/// Open Image Denoise over the picture, guided by albedo and normal, which are filtered first
/// (kOidn) or taken as they are sampled (kOidnFast). Never over ids, depth or normals.
enum class Denoise { kOff, kOidn, kOidnFast };
inline constexpr std::array<const char*, 3> kDenoiseNames = {"off", "oidn", "oidn_fast"};

/// How often a path may go on after surfaces of a kind; none: as often as max_bounces says.
struct BounceLimits {
  std::optional<int> diffuse, glossy, transmission, transparent;

  bool operator==(const BounceLimits&) const = default;
};

/// What makes a picture cheaper or less noisy, and may change what is expected of it. All are off
/// by themselves, and were not there before version 6.
struct RenderLevers {
  BounceLimits bounces;
  double light_threshold = 0.0;  ///< lights that would add less, scene-linear, are often left out
  double clamp_direct = 0.0;     ///< limit of what one direct sample adds, scene-linear; 0: none
  double filter_glossy = 0.0;    ///< blurs reflections after a rough bounce (Cycles' blur_glossy)
  int texture_limit_px = 0;      ///< larger images are halved until their sides fit; 0: never
  bool path_guiding = false;     ///< directions learnt while rendering (Open PGL)

  bool operator==(const RenderLevers&) const = default;
};

struct RenderSettings {
  int width = 0;           ///< pixels
  int height = 0;          ///< pixels
  int samples = 0;         ///< of a pixel; with adaptive sampling at most
  std::uint32_t seed = 0;  ///< of Cycles, 31 bits
  int max_bounces = 0;
  double filter_width_px = 1.5;
  double clamp_indirect = 0.0;  ///< scene-linear, 0 for none
  bool depth = false;           ///< ask for the Depth pass
  bool normal = false;          ///< ask for the Normal pass
  AdaptiveSampling adaptive;
  Denoise denoise = Denoise::kOff;
  RenderLevers levers;
  /// Only these pixels of the image are rendered: its others are black, of no instance, and
  /// infinitely far. Since version 7; none: all.
  std::optional<PixelRect> region;

  /// What the passes of a worker have: the region, or the whole image.
  PixelRect rendered_pixels() const { return region.value_or(PixelRect{0, 0, width, height}); }
};

/// A camera at the origin, looking down -z, y up.
struct CameraSpec {
  std::array<double, 2> focal_px{};   ///< fx, fy
  std::array<double, 2> center_px{};  ///< principal point cx, cy; pixel centres are whole numbers
  double clip_start_m = 0.0;
  double clip_end_m = 0.0;
  double aperture_radius_m = 0.0;  ///< 0: a pinhole
  double focus_distance_m = 0.0;   ///< along -z; a pinhole has no use for it
};

/// Parameters of Blender's Principled BSDF. A texture is named by the SHA-256 of its file; a colour
/// texture is multiplied by base_color, the other textures replace their parameter.
struct MaterialSpec {
  Rgb base_color{};
  double metallic = 0.0;
  double roughness = 0.5;
  double specular = 0.5;
  double transmission = 0.0;
  double ior = 1.45;
  double clearcoat = 0.0;
  double texture_repeat = 1.0;                  ///< repeats per UV unit
  std::map<std::string, std::string> textures;  ///< "alpha", "color", "metallic", "normal", …

  bool operator==(const MaterialSpec&) const = default;
};

/// Kinds of rays that pass through an object as if it were not there.
struct HiddenFrom {
  bool camera = false, diffuse = false, glossy = false, transmission = false, shadow = false;

  bool operator==(const HiddenFrom&) const = default;
};

struct InstanceSpec {
  std::string name;   ///< "<object>/<copy>"
  int id = 0;         ///< value in the index pass; 0 for what is background (the ground)
  int category = 0;   ///< index into the campaign's categories + 1; 0 for what has no label
  std::string asset;  ///< its name; empty for the ground
  std::string mesh;   ///< SHA-256 of the mesh buffer
  std::vector<int> materials;  ///< for each material slot of the mesh an index into materials
  HiddenFrom hidden_from;
  std::vector<Keypoint> keypoints;  ///< the asset's
  Affine camera_from_object = Affine::Identity();
};

enum class LightKind { kPoint, kSun, kSpot, kArea };
inline constexpr std::array<const char*, 4> kLightKindNames = {"point", "sun", "spot", "area"};

/// Lights shine down their own -z, as Blender's do.
struct LightSpec {
  LightKind kind = LightKind::kPoint;
  Affine camera_from_light = Affine::Identity();
  Rgb color{};
  double power = 0.0;      ///< watts of radiant flux; for a sun W/m²
  double radius_m = 0.0;   ///< point and spot
  double angle_rad = 0.0;  ///< sun: angular diameter; spot: full cone angle
  double blend = 0.0;      ///< spot: softness of the edge, 0 to 1
  double width_m = 0.0;    ///< area
  double height_m = 0.0;   ///< area
};

/// Light from everywhere: one colour, or an environment map (equirectangular, z up) multiplied by
/// it.
struct WorldSpec {
  Rgb color{};
  double strength = 0.0;
  std::string hdri;  ///< SHA-256 of an image file, or empty
  /// Width of the map of brightness that Cycles makes in each frame, to aim at what is bright: its
  /// time and its noise depend on it, what is expected of the picture does not; with hdri only.
  int importance_map_px = 0;
  /// From directions in the camera's frame to those of the environment map; with hdri only.
  Eigen::Matrix3d map_from_camera = Eigen::Matrix3d::Identity();
};

/// Where labels come from: Blender's index pass, checked against the twin; or the twin alone,
/// without Blender.
enum class LabelSource { kIndexPass, kTwin };

struct LabelSettings {
  LabelSource source = LabelSource::kIndexPass;
  /// Whether the twin sees exactly what is rendered. Not with cut-out textures, whose holes only
  /// the renderer knows: there the index pass rules, and is not compared.
  bool twin_exact = true;
  /// Id of the instance that the frame is a picture of, which its image is cut to; 0: of the scene.
  /// Since version 7.
  int target = 0;
};

struct FrameSpec {
  RenderSettings render;
  CameraSpec camera;
  WorldSpec world;
  std::vector<MaterialSpec> materials;
  std::vector<InstanceSpec> instances;
  std::vector<LightSpec> lights;
  ImageSettings image;
  /// Since version 8; none: pictures are as colour management has them.
  std::optional<SensorSettings> sensor;
  LabelSettings labels;
};

/// The first part, instances aside, whose numbers are not all finite ("the camera"), or empty.
/// Such a spec has no JSON.
std::string non_finite_part(const FrameSpec& spec);

/// The canonical JSON, which is hashed and sent to workers.
std::string canonical_text(const FrameSpec& spec);
Json to_json(const FrameSpec& spec);

/// SHA-256 of the canonical text, 64 hex digits.
std::string frame_id(const FrameSpec& spec);

}  // namespace seedframe
