// What a ray through a pixel's centre meets first, without rounding: by CGAL's exact kernel.
#pragma once

#include <optional>
#include <vector>

#include "mesh/mesh_buffer.h"
#include "spec/frame_spec.h"

namespace seedframe {

struct ExactHit {
  int id = 0;               ///< of the instance; 0: nothing
  bool tie = false;         ///< another instance is at exactly the same depth
  bool on_an_edge = false;  ///< the ray meets an edge or a corner of the triangle
};

/// The frame's doubles and the meshes' floats are taken as they stand.
class ExactScene {
 public:
  ExactScene(const FrameSpec& spec, const MeshBuffers& buffers);
  ~ExactScene();
  ExactHit first_hit(int x, int y) const;

 private:
  struct Triangles;
  FrameSpec spec_;
  std::unique_ptr<Triangles> triangles_;
};

}  // namespace seedframe
