// What rays through pixel centres hit: exact occlusion in C++, by Embree.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <vector>

#include "geometry/mesh.h"

namespace seedframe {

/// A mesh's ray-tracing tree, in object space; shared by all of its instances and frames.
class RayMesh {
 public:
  explicit RayMesh(const Mesh& mesh);
  ~RayMesh();
  RayMesh(const RayMesh&) = delete;
  RayMesh& operator=(const RayMesh&) = delete;

  struct Tree;
  const Tree& tree() const { return *tree_; }

 private:
  std::unique_ptr<Tree> tree_;
};

/// A pinhole at the origin that looks down -z with y up; pixel centres are whole numbers, y down.
struct PixelCamera {
  int width = 0;
  int height = 0;
  std::array<double, 2> focal_px{};
  std::array<double, 2> center_px{};
  double clip_start_m = 0.0;
  double clip_end_m = 0.0;
};

struct RayInstance {
  std::shared_ptr<const RayMesh> mesh;
  BoundingBox box;  ///< of the mesh
  Eigen::Affine3d camera_from_object = Eigen::Affine3d::Identity();
  bool seen = true;  ///< false: rays of the camera pass through
};

/// Pixels of one instance, at the centres of a grid over its projection.
struct PixelCounts {
  double whole = 0.0;     ///< its full silhouette, also outside the image and behind others
  double in_image = 0.0;  ///< of that, inside the image
  double visible = 0.0;   ///< of that, not hidden by others
};

/// One frame's instances.
class VisibilityScene {
 public:
  VisibilityScene(const PixelCamera& camera, std::vector<RayInstance> instances);
  ~VisibilityScene();

  /// Index of the instance that the ray through the centre of a pixel hits first; -1: none.
  int first_hit(int x, int y) const;

  /// Looks at no more than about `most_rays` pixels: an instance with a larger projection is
  /// counted on every second, third, … pixel both ways and scaled up. What is farther out of view
  /// than the image is wide or high is not looked for.
  PixelCounts count(std::size_t instance, std::size_t most_rays) const;

 private:
  struct Scene;
  PixelCamera camera_;
  std::vector<RayInstance> instances_;
  std::unique_ptr<Scene> scene_;
};

}  // namespace seedframe
