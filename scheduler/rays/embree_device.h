// What ray_mesh and ray_scene share of Embree; no header outside of them includes this.
#pragma once

#include <cstddef>

#include <embree3/rtcore.h>

#include "rays/ray_mesh.h"

namespace seedframe {

/// One device for the process. Its own threads are not used: scenes are built by their callers.
RTCDevice embree_device();

/// In the mode in which no ray slips through between neighbouring triangles.
RTCScene new_embree_scene();

/// Builds the tree; std::bad_alloc when there is no memory for it.
void commit_scene(RTCScene scene);

struct RayMesh::Tree {
  RTCScene scene = new_embree_scene();
  const std::array<float, 3>* positions = nullptr;          ///< Embree's own copy
  const std::array<std::uint32_t, 3>* triangles = nullptr;  ///< the same
  std::size_t vertex_count = 0;
  std::size_t triangle_count = 0;

  Tree() = default;
  ~Tree() { rtcReleaseScene(scene); }
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
};

}  // namespace seedframe
