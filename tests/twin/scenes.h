// Frame specs of cubes for the tests of the twin.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/sha256.h"
#include "mesh/mesh_buffer.h"
#include "spec/frame_spec.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {

/// A cube of 2 m sides about the origin, as a mesh buffer by its hash.
struct CubeBuffer {
  std::string sha256;
  MeshBuffers buffers;
  CubeBuffer() {
    const auto bytes = std::make_shared<const std::string>(mesh_buffer(example_cube()));
    sha256 = sha256_hex(*bytes);
    buffers[sha256] = bytes;
  }
};

/// 160 × 120 pixels, 100 px of focal length.
inline FrameSpec empty_spec() {
  FrameSpec spec;
  spec.render.width = 160;
  spec.render.height = 120;
  spec.camera.focal_px = {100.0, 100.0};
  spec.camera.center_px = {79.5, 59.5};
  spec.camera.clip_start_m = 0.01;
  spec.camera.clip_end_m = 1000.0;
  return spec;
}

inline InstanceSpec cube_at(const CubeBuffer& cube, int id, double x, double y, double z,
                            double half_side = 1.0) {
  InstanceSpec instance;
  instance.name = "cube/" + std::to_string(id);
  instance.id = id;
  instance.category = 1;
  instance.mesh = cube.sha256;
  instance.materials = {0, 0};
  instance.camera_from_object.translate(Eigen::Vector3d(x, y, z));
  instance.camera_from_object.scale(half_side);
  return instance;
}

}  // namespace seedframe
