// Embree's trees over the instances of a frame; no header outside of rays includes this.
#pragma once

#include <vector>

#include "rays/embree_device.h"
#include "rays/projected_box.h"
#include "rays/ray_scene.h"

namespace seedframe {

struct RayScene::Scene {
  PixelCamera camera;  ///< with the start of its rays
  PixelRays pixels;
  std::vector<RayInstance> instances;
  std::vector<ProjectedBox> boxes;      ///< of all instances
  std::vector<unsigned> masks;          ///< by instance, one bit
  RTCScene all = new_embree_scene();    ///< every seen instance, by its index
  mutable std::vector<RTCScene> alone;  ///< each by itself, made when asked for
  mutable RTCScene shades = nullptr;    ///< see throwing_shadows

  Scene(const PixelCamera& pixel_camera, std::vector<RayInstance> seen_and_unseen);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  RTCScene only(std::size_t index) const;
  /// The instances that throw shadows, each by its index.
  RTCScene throwing_shadows() const;
  /// Whether no other instance has its mask where both might be seen: then rays of this mask are as
  /// good as a tree of its own.
  bool has_own_mask(std::size_t index) const;

 private:
  /// A colouring of the instances whose rectangles overlap, with 32 colours.
  void choose_masks();
};

}  // namespace seedframe
