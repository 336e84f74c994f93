#include "annotate/boundary.h"

#include <array>
#include <cassert>

namespace seedframe {
namespace {

struct Step {
  int row;
  int column;
};
/// Where a walk along a side goes, by Side.
constexpr std::array<Step, 4> kAhead = {{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};

constexpr int turn(Side side, int quarters) { return (static_cast<int>(side) + quarters) & 3; }

/// The crack that the walk takes after this one: the leftmost that has the mask on its right, which
/// is what makes the mask 8-connected.
Crack next_crack(const Mask& mask, const Crack& crack) {
  const Step ahead = kAhead[static_cast<std::size_t>(turn(crack.side, 0))];
  const Step left = kAhead[static_cast<std::size_t>(turn(crack.side, 3))];
  const int row = crack.row + ahead.row;
  const int column = crack.column + ahead.column;
  if (mask.at(row + left.row, column + left.column)) {
    return {row + left.row, column + left.column, static_cast<Side>(turn(crack.side, 3))};
  }
  if (mask.at(row, column)) return {row, column, crack.side};
  return {crack.row, crack.column, static_cast<Side>(turn(crack.side, 1))};
}

std::size_t position_in(const PixelRect& box, int row, int column) {
  return static_cast<std::size_t>(row - box.y) * static_cast<std::size_t>(box.width) +
         static_cast<std::size_t>(column - box.x);
}

/// Walks once around, from the top side of a pixel.
void trace_ring(const Mask& mask, int row, int column, Boundary& boundary) {
  CrackRing ring{.first = boundary.cracks.size()};
  // Twice the enclosed area is the sum over both pairs of sides; one pair gives the area itself.
  std::int64_t area = 0;
  Crack crack{row, column, Side::kTop};
  do {
    if (crack.side == Side::kTop) {
      area -= crack.row;
      boundary.top_cracks[position_in(boundary.box, crack.row, crack.column)] =
          static_cast<std::ptrdiff_t>(boundary.cracks.size());
    } else if (crack.side == Side::kBottom) {
      area += crack.row + 1;
    }
    boundary.cracks.push_back(crack);
    boundary.ring_of_crack.push_back(boundary.rings.size());
    crack = next_crack(mask, crack);
  } while (crack.row != row || crack.column != column || crack.side != Side::kTop);
  assert(area != 0);
  ring.count = boundary.cracks.size() - ring.first;
  ring.hole = area < 0;
  boundary.rings.push_back(ring);
}

}  // namespace

std::size_t Boundary::top_crack(int row, int column) const {
  const std::ptrdiff_t crack = top_cracks[position_in(box, row, column)];
  assert(crack >= 0);
  return static_cast<std::size_t>(crack);
}

Boundary trace_boundary(const Mask& mask) {
  Boundary boundary;
  const PixelRect& box = mask.box();
  boundary.box = box;
  boundary.top_cracks.assign(
      static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height), -1);
  for (int row = box.y; row < box.end_y(); ++row) {
    for (int column = box.x; column < box.end_x(); ++column) {
      if (!mask.at(row, column) || mask.at(row - 1, column)) continue;
      if (boundary.top_cracks[position_in(box, row, column)] >= 0) continue;
      trace_ring(mask, row, column, boundary);
    }
  }
  return boundary;
}

}  // namespace seedframe
