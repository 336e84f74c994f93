#include "mesh/mesh_diameter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace seedframe {
namespace {

struct Cell {
  BoundingBox box;
  std::vector<Eigen::Vector3d> points;
};

/// Vertices by the cells of a grid of as many along each side.
std::vector<Cell> cells_of(const Mesh& mesh, int per_side) {
  const BoundingBox box = bounding_box(mesh);
  const double side = std::max(box.size().maxCoeff() / per_side, 1e-300);
  std::map<std::array<int, 3>, Cell> cells;
  for (const auto& position : mesh.positions) {
    const Eigen::Vector3d point(position[0], position[1], position[2]);
    const Eigen::Vector3d at = (point - box.low) / side;
    Cell& cell =
        cells[{static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z())}];
    if (cell.points.empty()) cell.box = {point, point};
    cell.box.low = cell.box.low.cwiseMin(point);
    cell.box.high = cell.box.high.cwiseMax(point);
    cell.points.push_back(point);
  }
  std::vector<Cell> list;
  list.reserve(cells.size());
  for (auto& [key, cell] : cells) list.push_back(std::move(cell));
  return list;
}

double squared_most(const BoundingBox& a, const BoundingBox& b) {
  return (a.high - b.low).cwiseAbs().cwiseMax((b.high - a.low).cwiseAbs()).squaredNorm();
}

/// A pair that is far apart: from any vertex to the farthest, and on, a few times.
double squared_guess(const std::vector<Cell>& cells) {
  Eigen::Vector3d from = cells.front().points.front();
  double best = 0.0;
  for (int i = 0; i < 4; ++i) {
    Eigen::Vector3d farthest = from;
    for (const Cell& cell : cells) {
      for (const Eigen::Vector3d& point : cell.points) {
        if ((point - from).squaredNorm() > (farthest - from).squaredNorm()) farthest = point;
      }
    }
    best = std::max(best, (farthest - from).squaredNorm());
    from = farthest;
  }
  return best;
}

}  // namespace

double mesh_diameter(const Mesh& mesh) {
  if (mesh.positions.empty()) return 0.0;
  constexpr int kPerSide = 24;
  const std::vector<Cell> cells = cells_of(mesh, kPerSide);
  double best = squared_guess(cells);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t j = i; j < cells.size(); ++j) {
      if (squared_most(cells[i].box, cells[j].box) <= best) continue;
      for (const Eigen::Vector3d& a : cells[i].points) {
        for (const Eigen::Vector3d& b : cells[j].points) {
          best = std::max(best, (a - b).squaredNorm());
        }
      }
    }
  }
  return std::sqrt(best);
}

}  // namespace seedframe
