// A triangle mesh in object space, and the questions that placement asks of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

/// Metres, z up. Triangles run counter-clockwise seen from outside.
struct Mesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into positions
  std::vector<std::array<float, 2>> corner_uvs;         ///< three per triangle; v points up
  std::vector<std::uint32_t> triangle_slots;            ///< per triangle an index into slot_names
  std::vector<std::string> slot_names;                  ///< material slots, at least one
  double smooth_angle_rad = 0.0;  ///< edges sharper than this are shaded sharp; 0: all flat
};

/// Axis-aligned, metres. An empty mesh has a box from 0 to 0.
struct BoundingBox {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();

  Eigen::Vector3d size() const { return high - low; }
  Eigen::Vector3d centre() const { return 0.5 * (low + high); }
  /// x alternates fastest between low and high, then y, then z.
  std::array<Eigen::Vector3d, 8> corners() const;
};

BoundingBox bounding_box(const Mesh& mesh);

/// Square metres.
double surface_area(const Mesh& mesh);

/// What every other function here takes for granted: something to see (triangles whose area is not
/// zero), finite coordinates, indices in range and arrays of the right lengths. `what` names the
/// mesh in the error (kInput).
Status check_mesh(const Mesh& mesh, const std::string& what);

/// The least z over all vertices after the linear map, in metres: how far below its origin an
/// object reaches when it is turned and scaled by `linear`. Looks at every vertex.
double lowest_z(const Mesh& mesh, const Eigen::Matrix3d& linear);

/// Answers lowest_z for one mesh and many maps: the same numbers to the last bit, from a few
/// vertices. Vertices are kept in groups with a bounding box each, and groups that lie too high are
/// skipped.
class LowestPoint {
 public:
  LowestPoint() = default;
  explicit LowestPoint(const Mesh& mesh);

  double z(const Eigen::Matrix3d& linear) const;

 private:
  struct Group {
    std::array<double, 3> centre;
    std::array<double, 3> half_size;
    std::size_t first;  ///< into vertices_
    std::size_t count;
  };
  void split(std::size_t first, std::size_t count);

  std::vector<std::array<float, 3>> vertices_;
  std::vector<Group> groups_;
  float lowest_ = 0.0F, highest_ = 0.0F;  ///< z of all vertices
};

}  // namespace seedframe
