#include "annotate/part_bridges.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <tuple>

#include <boost/pending/disjoint_sets.hpp>

namespace seedframe {
namespace {

constexpr std::ptrdiff_t kNobody = -1;

/// For each pixel of the box a crack of the nearest part; kNobody inside the parts.
class NearestCracks {
 public:
  NearestCracks(const Mask& mask, const Boundary& boundary) : box_(mask.box()) {
    nearest_.assign(static_cast<std::size_t>(box_.width) * static_cast<std::size_t>(box_.height),
                    kNobody);
    std::vector<Pixel> front;
    for (std::size_t i = 0; i < boundary.cracks.size(); ++i) {
      const Crack& crack = boundary.cracks[i];
      claim({crack.row, crack.column}, static_cast<std::ptrdiff_t>(i), front);
    }
    while (!front.empty()) front = advance(mask, front);
  }

  std::ptrdiff_t at(int row, int column) const {
    if (!box_.contains(column, row)) return kNobody;
    return nearest_[position({row, column})];
  }

 private:
  struct Pixel {
    int row;
    int column;
  };

  std::size_t position(Pixel pixel) const {
    return static_cast<std::size_t>(pixel.row - box_.y) * static_cast<std::size_t>(box_.width) +
           static_cast<std::size_t>(pixel.column - box_.x);
  }

  void claim(Pixel pixel, std::ptrdiff_t crack, std::vector<Pixel>& front) {
    std::ptrdiff_t& owner = nearest_[position(pixel)];
    if (owner != kNobody) return;
    owner = crack;
    front.push_back(pixel);
  }

  /// One more step of a breadth-first search: the background pixels around the front.
  std::vector<Pixel> advance(const Mask& mask, const std::vector<Pixel>& front) {
    std::vector<Pixel> next;
    for (const Pixel& pixel : front) {
      const std::ptrdiff_t owner = nearest_[position(pixel)];
      for (int row = std::max(pixel.row - 1, box_.y);
           row <= std::min(pixel.row + 1, box_.end_y() - 1); ++row) {
        for (int column = std::max(pixel.column - 1, box_.x);
             column <= std::min(pixel.column + 1, box_.end_x() - 1); ++column) {
          if (!mask.at(row, column)) claim({row, column}, owner, next);
        }
      }
    }
    return next;
  }

  PixelRect box_;
  std::vector<std::ptrdiff_t> nearest_;
};

struct Candidate {
  int length;
  std::size_t from_crack;
  std::size_t to_crack;
  bool operator<(const Candidate& other) const {
    return std::tie(length, from_crack, to_crack) <
           std::tie(other.length, other.from_crack, other.to_crack);
  }
};

/// A bridge wherever the regions of two parts meet.
std::vector<Candidate> find_candidates(const Mask& mask, const Boundary& boundary,
                                       const std::vector<std::size_t>& part_of_ring) {
  const NearestCracks nearest(mask, boundary);
  const PixelRect& box = mask.box();
  std::vector<Candidate> candidates;
  const auto part = [&](std::size_t crack) { return part_of_ring[boundary.ring_of_crack[crack]]; };
  constexpr std::array<std::array<int, 2>, 4> kNeighbours = {{{0, 1}, {1, -1}, {1, 0}, {1, 1}}};
  for (int row = box.y; row < box.end_y(); ++row) {
    for (int column = box.x; column < box.end_x(); ++column) {
      const std::ptrdiff_t here = nearest.at(row, column);
      if (here == kNobody) continue;
      for (const auto& [down, right] : kNeighbours) {
        const std::ptrdiff_t there = nearest.at(row + down, column + right);
        if (there == kNobody) continue;
        const auto from = static_cast<std::size_t>(std::min(here, there));
        const auto to = static_cast<std::size_t>(std::max(here, there));
        if (part(from) == part(to)) continue;
        const Crack& a = boundary.cracks[from];
        const Crack& b = boundary.cracks[to];
        const int length = std::max(std::abs(a.row - b.row), std::abs(a.column - b.column));
        candidates.push_back({length, from, to});
      }
    }
  }
  return candidates;
}

}  // namespace

// Kruskal's minimum spanning tree over the pairs of parts whose regions of nearest pixels meet.
std::vector<PartBridge> bridge_parts(const Mask& mask, const Boundary& boundary,
                                     const std::vector<std::size_t>& part_of_ring,
                                     std::size_t parts) {
  std::vector<PartBridge> bridges;
  if (parts < 2) return bridges;
  std::vector<Candidate> candidates = find_candidates(mask, boundary, part_of_ring);
  std::sort(candidates.begin(), candidates.end());
  boost::disjoint_sets_with_storage<> trees(parts);
  for (const Candidate& candidate : candidates) {
    const std::size_t from = part_of_ring[boundary.ring_of_crack[candidate.from_crack]];
    const std::size_t to = part_of_ring[boundary.ring_of_crack[candidate.to_crack]];
    if (trees.find_set(from) == trees.find_set(to)) continue;
    trees.union_set(from, to);
    bridges.push_back({candidate.from_crack, candidate.to_crack});
  }
  assert(bridges.size() + 1 == parts);
  return bridges;
}

namespace {

struct PartSize {
  std::int64_t area_px = 0;
  std::array<bool, 4> reaches{};  ///< the mask's box on its left, upper, right and lower side
};

std::vector<PartSize> part_sizes(const Boundary& boundary,
                                 const std::vector<std::size_t>& part_of_ring, std::size_t parts) {
  std::vector<PartSize> sizes(parts);
  const PixelRect& box = boundary.box;
  for (std::size_t i = 0; i < boundary.cracks.size(); ++i) {
    const Crack& crack = boundary.cracks[i];
    PartSize& size = sizes[part_of_ring[boundary.ring_of_crack[i]]];
    // In each column, what is above lower sides less what is above upper sides.
    if (crack.side == Side::kBottom) size.area_px += crack.row + 1;
    if (crack.side == Side::kTop) size.area_px -= crack.row;
    const std::array<bool, 4> reaches = {crack.column == box.x, crack.row == box.y,
                                         crack.column == box.end_x() - 1,
                                         crack.row == box.end_y() - 1};
    for (std::size_t k = 0; k < reaches.size(); ++k) {
      size.reaches[k] = size.reaches[k] || reaches[k];
    }
  }
  return sizes;
}

}  // namespace

WorthwhileParts worthwhile_parts(const Boundary& boundary,
                                 const std::vector<std::size_t>& part_of_ring, std::size_t parts,
                                 const std::vector<PartBridge>& bridges) {
  WorthwhileParts out{std::vector<bool>(parts, true), 0};
  if (parts < 2) return out;
  const std::vector<PartSize> sizes = part_sizes(boundary, part_of_ring, parts);
  std::array<std::int64_t, 4> reaching{};  // kept parts that hold the box on each side
  for (const PartSize& size : sizes) {
    for (std::size_t k = 0; k < reaching.size(); ++k) reaching[k] += size.reaches[k];
  }
  struct Neighbour {
    std::size_t part;
    std::int64_t painted_px;
  };
  std::vector<std::vector<Neighbour>> neighbours(parts);
  for (const PartBridge& bridge : bridges) {
    const Crack& from = boundary.cracks[bridge.from_crack];
    const Crack& to = boundary.cracks[bridge.to_crack];
    const std::int64_t painted =
        std::max(std::abs(from.row - to.row), std::abs(from.column - to.column)) - 1;
    const std::size_t a = part_of_ring[boundary.ring_of_crack[bridge.from_crack]];
    const std::size_t b = part_of_ring[boundary.ring_of_crack[bridge.to_crack]];
    neighbours[a].push_back({b, painted});
    neighbours[b].push_back({a, painted});
  }
  std::vector<std::size_t> ends(parts);
  std::iota(ends.begin(), ends.end(), std::size_t{0});
  while (!ends.empty()) {
    const std::size_t part = ends.back();
    ends.pop_back();
    if (!out.kept[part] || neighbours[part].size() != 1) continue;
    const Neighbour neighbour = neighbours[part].front();
    bool needed = sizes[part].area_px >= neighbour.painted_px;
    for (std::size_t k = 0; k < reaching.size(); ++k) {
      needed = needed || (sizes[part].reaches[k] && reaching[k] == 1);
    }
    if (needed) continue;
    out.kept[part] = false;
    out.left_out_px += sizes[part].area_px;
    for (std::size_t k = 0; k < reaching.size(); ++k) reaching[k] -= sizes[part].reaches[k];
    auto& others = neighbours[neighbour.part];
    others.erase(std::find_if(others.begin(), others.end(),
                              [&](const Neighbour& each) { return each.part == part; }));
    ends.push_back(neighbour.part);
  }
  return out;
}

}  // namespace seedframe
