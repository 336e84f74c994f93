// How high a mesh is over the plane below it: what is seen of it straight from above or from below.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/mesh.h"

namespace seedframe {

/// Heights at the middles of kHeightSamples × kHeightSamples cells of the mesh's bounding
/// rectangle.
class HeightMap {
 public:
  enum class Side {
    kAbove,  ///< the highest point over a place
    kBelow,  ///< the lowest
  };

  HeightMap(const Mesh& mesh, const Eigen::Affine3d& world_from_object, Side side);

  double low_x() const { return low_.x(); }
  double low_y() const { return low_.y(); }
  double high_x() const { return high_.x(); }
  double high_y() const { return high_.y(); }

  /// Of the cell that holds a place; NaN where there is no mesh.
  double at(double x, double y) const;

  /// Calls visit(x, y, height) for every cell that holds some of the mesh at its middle.
  template <class Visit>
  void for_each(const Visit& visit) const;

 private:
  double& cell(int row, int column);
  void add_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    Side side);

  Eigen::Vector2d low_, high_, step_;  ///< step_: size of a cell
  std::vector<double> heights_;        ///< by rows; NaN: none
};

constexpr int kHeightSamples = 48;

/// How far `upper`, seen from below, reaches into `lower`, seen from above: the distance by which
/// it must be raised to lie on it. 0 where they do not reach over each other. To within what their
/// heights change from one cell to the next.
double overlap_of(const HeightMap& lower, const HeightMap& upper);

template <class Visit>
void HeightMap::for_each(const Visit& visit) const {
  auto height = heights_.begin();
  for (int row = 0; row < kHeightSamples; ++row) {
    for (int column = 0; column < kHeightSamples; ++column, ++height) {
      if (*height != *height) continue;
      visit(low_.x() + (column + 0.5) * step_.x(), low_.y() + (row + 0.5) * step_.y(), *height);
    }
  }
}

}  // namespace seedframe
