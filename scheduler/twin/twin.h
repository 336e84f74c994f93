// The twin: a frame's exact geometry in C++, traced from its frame spec without Blender.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/image.h"
#include "mesh/mesh_buffer.h"
#include "rays/ray_scene.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// One frame as rays through its pixels' centres see it.
class Twin {
 public:
  /// 0 is background, and what is outside of the spec's region.
  Image<std::uint16_t> instance_ids;
  std::optional<Image<float>> depth;   ///< planar, metres; kNoDepth where there is nothing
  std::optional<Image<float>> normal;  ///< x, y, z in the camera's frame; 0 where there is nothing

  /// One for each instance of the spec, empty for those without an id. Each contains every pixel
  /// that `visible_ids` gives to its instance; that is instance_ids, or what Blender rendered.
  std::vector<Silhouette> silhouettes(const Image<std::uint16_t>& visible_ids) const;

  /// Whether something stands between the camera and a point of its frame; see RayScene::hides.
  bool hides(const Eigen::Vector3d& point, double tolerance_m, int transparent) const {
    return scene_.hides(point, tolerance_m, transparent);
  }

  /// Whether a ray through the pixel, within a hundredth of a pixel of its centre, sees this id:
  /// then rounding decides which id the pixel gets.
  bool grazes(int row, int column, std::uint16_t id) const;

  /// Whether this id's surface coincides, in the pixel's centre, with what the twin sees there:
  /// then rounding decides too.
  bool coincides(int row, int column, std::uint16_t id) const;

  /// Of the instances that rounding decides between in the pixel's centre; see
  /// RayScene::first_hits.
  std::vector<int> first_hits(int row, int column) const { return scene_.first_hits(column, row); }

  /// What was traced, and what it was traced in. Instances are those of the spec, by their index.
  const RayImage& rays() const { return image_; }
  const RayScene& scene() const { return scene_; }

  /// Of an instance's mesh, in object space, metres.
  const BoundingBox& object_box(std::size_t instance) const { return object_boxes_[instance]; }

 private:
  friend class TwinTracer;
  /// What is known of each instance, by its index.
  struct Names {
    std::vector<int> ids;
    std::vector<BoundingBox> object_boxes;
  };
  Twin(RayScene scene, RayImage image, Names names);
  /// Nothing is seen in the pixels outside.
  void keep_only(const PixelRect& region);

  RayScene scene_;
  RayImage image_;
  std::vector<int> ids_;
  std::vector<BoundingBox> object_boxes_;
};

/// Traces frames, and keeps the trees of their meshes for the next. Safe to use from several
/// threads.
class TwinTracer {
 public:
  /// `threads` for each frame.
  explicit TwinTracer(int threads = 1) : threads_(threads) {}

  enum class Passes {
    kIdsOnly,
    kAsked,     ///< depth and normal too when the spec asks for them
    kSurfaces,  ///< of rays(): depth, normals and points
  };
  /// `buffers` holds those of the spec's meshes; a damaged or a missing one is an error, as is a
  /// lack of memory (kExhausted).
  Result<Twin> trace(const FrameSpec& spec, const MeshBuffers& buffers, Passes passes);

 private:
  /// A mesh, moved so that `origin` (object space, metres) is at 0.
  struct MovedMesh {
    std::shared_ptr<const RayMesh> mesh;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  };
  struct Entry {
    MovedMesh moved;
    std::uint64_t last_used = 0;
  };
  Result<MovedMesh> mesh(const std::string& sha256, const MeshBuffers& buffers);
  /// Drops what was used least recently.
  void trim();

  int threads_;
  std::mutex mutex_;  ///< guards what follows
  std::map<std::string, Entry> meshes_;
  std::uint64_t uses_ = 0;
  std::size_t triangles_ = 0;  ///< of all meshes_
};

/// The pinhole of a frame, its depth of field left aside.
PixelCamera pixel_camera(const FrameSpec& spec);

}  // namespace seedframe
