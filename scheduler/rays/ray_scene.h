// What rays through pixel centres hit: exact occlusion in C++, by Embree.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/pixel_rect.h"
#include "rays/pixel_camera.h"
#include "rays/ray_mesh.h"

namespace seedframe {

struct RayInstance {
  std::shared_ptr<const RayMesh> mesh;
  Eigen::Affine3d camera_from_object = Eigen::Affine3d::Identity();
  bool seen = true;           ///< false: rays of the camera pass through
  bool throws_shadow = true;  ///< false: rays of light pass through
};

/// Planar depth where a ray hits nothing: as in Blender's Depth pass.
inline constexpr float kNoDepth = 1e10f;

/// A point of a mesh.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  float u = 0.0F, v = 0.0F;  ///< shares of the triangle's second and third corner
};

/// What the image's pixels see, row by row from the top.
struct RayImage {
  int width = 0;
  int height = 0;
  std::vector<std::int32_t> instance;         ///< index of an instance; -1: nothing
  std::vector<float> depth;                   ///< planar, metres; kNoDepth; empty: not asked for
  std::vector<std::array<float, 3>> normals;  ///< see TraceOptions; empty: not asked for
  std::vector<SurfacePoint> points;           ///< of no meaning where nothing is hit; the same

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

struct TraceOptions {
  bool depth = false;
  /// With `depth`: the same bits on every CPU, which costs a little more.
  bool portable_depth = false;
  /// Shading normals in the camera's frame, of unit length, on the side that the ray comes from; 0
  /// where it hits nothing. The same bits on every CPU.
  bool normals = false;
  bool points = false;  ///< the same bits on every CPU
  int threads = 1;
};

/// A ray of light, followed backwards from where it arrives.
struct LightRay {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();       ///< in the camera's frame, metres
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< of unit length
  double length_m = std::numeric_limits<double>::infinity();
};

/// What a ray of light comes from.
struct LightHit {
  int instance = -1;  ///< index; -1: from nothing
  std::uint32_t triangle = 0;
  float distance_m = 0.0F;
};

/// The amodal mask of one instance: what it would show if nothing stood before it and the image
/// had no edge.
struct Silhouette {
  PixelRect box;                   ///< tight; empty when it shows nowhere on the canvas
  std::vector<std::uint8_t> mask;  ///< 0 or 1 for each pixel of the box, row by row
  std::int64_t area_px = 0;        ///< of the mask
  std::int64_t in_image_px = 0;    ///< of it, inside the image
  bool complete = true;            ///< false: it reaches the edge of the enlarged canvas
};

/// Pixels of one instance, at the centres of a grid over its projection.
struct PixelCounts {
  double whole = 0.0;     ///< its full silhouette, also outside the image and behind others
  double in_image = 0.0;  ///< of that, inside the image
  double visible = 0.0;   ///< of that, not hidden by others
};

/// One frame's instances. Where surfaces coincide, either may be hit: see docs/twin.md.
class RayScene {
 public:
  /// Throws std::bad_alloc when there is no memory for the tree.
  RayScene(const PixelCamera& camera, std::vector<RayInstance> instances);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const PixelCamera& camera() const;
  const std::vector<RayInstance>& instances() const;

  /// Index of the instance that the ray through the centre of a pixel, or `offset_px` beside it,
  /// hits first; -1: none.
  int first_hit(int x, int y, const std::array<double, 2>& offset_px = {}) const;

  /// The instances whose surfaces the ray through a pixel's centre meets first, so close together
  /// that rounding decides which of them is seen: within 1/100,000 of their depth. Empty: it meets
  /// none. Not from several threads at once.
  std::vector<int> first_hits(int x, int y) const;

  /// Whether a surface stands between the camera and a point of its frame, `tolerance_m` or more
  /// before it. `transparent`: the index of an instance that hides nothing; -1: none.
  bool hides(const Eigen::Vector3d& point, double tolerance_m, int transparent) const;

  /// The same pixels whatever the number of threads.
  RayImage trace(const TraceOptions& options) const;

  /// For each ray whether something that throws shadows is in its way. Not from several threads at
  /// once, as find_hits.
  void find_shadows(std::span<const LightRay> rays, std::span<std::uint8_t> in_shadow) const;

  /// For each ray the first thing that throws shadows.
  void find_hits(std::span<const LightRay> rays, std::span<LightHit> hits) const;

  /// Contains every pixel of the image that `image` gives to the instance and that is in `within`
  /// or near the instance. With the depth of `image`, which must be as trace() gave it, only what
  /// could be hidden is traced. Not for one instance from several threads at once.
  Silhouette silhouette(std::size_t instance, const RayImage& image,
                        const PixelRect& within = {}) const;

  /// Looks at no more than about `most_rays` pixels: an instance with a larger projection is
  /// counted on every second, third, … pixel both ways and scaled up. What is out of the enlarged
  /// canvas is not looked for.
  PixelCounts count(std::size_t instance, std::size_t most_rays) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace seedframe
