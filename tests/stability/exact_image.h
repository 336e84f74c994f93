// What every pixel of a frame shows, without rounding that could be seen.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesh/mesh_buffer.h"
#include "spec/frame_spec.h"

namespace seedframe {

struct ExactPixel {
  std::uint16_t id = 0;  ///< 0: nothing
  bool tie = false;      ///< two instances at exactly the same depth: either is right
  double depth = 0.0;    ///< planar, metres
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< shading normal, towards the camera
};

struct ExactImage {
  int width = 0;
  std::vector<ExactPixel> pixels;  ///< row by row
  std::int64_t asked = 0;          ///< of them, decided by CGAL's exact kernel

  const ExactPixel& at(int row, int column) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(column)];
  }
};

/// Tests every triangle against the pixels that it may cover in double, with a bound of the
/// rounding errors. Where these could decide what a pixel shows, the exact kernel does
/// (exact_hits.h). Depth and normals follow in double from the triangle that is hit.
class ExactTracer {
 public:
  struct Solid {
    Mesh mesh;
    std::vector<std::array<float, 3>> normals;  ///< three per triangle, object space
  };

  explicit ExactTracer(const MeshBuffers& buffers) : buffers_(buffers) {}
  ExactImage trace(const FrameSpec& spec);

 private:
  const Solid& solid(const std::string& mesh);

  const MeshBuffers& buffers_;
  std::map<std::string, Solid> solids_;
};

}  // namespace seedframe
