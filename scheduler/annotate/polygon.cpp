#include "annotate/polygon.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

#include "annotate/boundary.h"
#include "annotate/part_bridges.h"

namespace seedframe {
namespace {

/// A corner of a mask pixel that a walk passes.
struct Stop {
  int row;
  int column;
  bool south;
  bool east;
  bool bridge;  ///< an end of a bridge
  std::size_t next;
};

/// The rings of a boundary as circular lists of stops, which can be joined into longer walks.
/// Crack k has the stops 2k (where it begins) and 2k + 1 (where it ends).
class Walks {
 public:
  Walks(const Mask& mask, const Boundary& boundary) : mask_(mask) {
    stops_.reserve(2 * boundary.cracks.size());
    for (const CrackRing& ring : boundary.rings) {
      for (std::size_t k = ring.first; k < ring.first + ring.count; ++k) {
        const bool last = k + 1 == ring.first + ring.count;
        add_stop(boundary.cracks[k], 0, 2 * k + 1);
        add_stop(boundary.cracks[k], 1, 2 * (last ? ring.first : k + 1));
      }
    }
  }

  /// Makes one walk of two: at the end of crack `from` it goes over to the beginning of crack `to`,
  /// around, and back the same way. Both ends of the bridge are doubled for that, and the
  /// successors of one copy each exchanged.
  void join(std::size_t from, std::size_t to) { join_over({}, from, to); }

  /// The same, over background pixels: along a diagonal, and then along a row or a column. On the
  /// way the walk stands at the same corner of every pixel, chosen so that it leaves a row and a
  /// column at once: wherever a loader puts further points on it, they are in the pixels of the
  /// bridge, on the way there as on the way back.
  void join_parts(std::size_t from, std::size_t to) {
    const Stop& begin = stops_[2 * from + 1];
    const Stop& end = stops_[2 * to];
    const int down = end.row - begin.row;
    const int right = end.column - begin.column;
    const int diagonal = std::min(std::abs(down), std::abs(right));
    const Stop first = {.row = begin.row,
                        .column = begin.column,
                        .south = (down < 0) != (right < 0),
                        .east = false,
                        .bridge = true,
                        .next = 0};
    Stop turn = first;
    turn.row += down < 0 ? -diagonal : diagonal;
    turn.column += right < 0 ? -diagonal : diagonal;
    Stop last = first;
    last.row = end.row;
    last.column = end.column;
    join_over({first, turn, last}, from, to);
  }

  /// The walk that passes the beginning of a crack, without vertices on straight lines.
  Polygon polygon(std::size_t crack, const VertexPlacement& placement) const;

 private:
  void join_over(std::vector<Stop> way, std::size_t from, std::size_t to) {
    const std::size_t from_stop = 2 * from + 1;
    const std::size_t to_stop = 2 * to;
    const std::size_t from_copy = double_stop(from_stop);
    const std::size_t to_copy = double_stop(to_stop);
    link(from_stop, way, to_copy);
    std::reverse(way.begin(), way.end());
    link(to_stop, way, from_copy);
  }

  /// Goes from a stop over new ones to another.
  void link(std::size_t stop, const std::vector<Stop>& way, std::size_t end) {
    for (const Stop& between : way) {
      stops_[stop].next = stops_.size();
      stop = stops_.size();
      stops_.push_back(between);
    }
    stops_[stop].next = end;
  }

  void add_stop(const Crack& crack, int end, std::size_t next) {
    const int corner = (static_cast<int>(crack.side) + end) & 3;  // from top left, clockwise
    stops_.push_back({.row = crack.row,
                      .column = crack.column,
                      .south = corner >= 2,
                      .east = corner == 1 || corner == 2,
                      .bridge = false,
                      .next = next});
  }

  std::size_t double_stop(std::size_t stop) {
    stops_[stop].bridge = true;
    const Stop copy = stops_[stop];
    stops_[stop].next = stops_.size();
    stops_.push_back(copy);
    return stops_.size() - 1;
  }

  std::optional<Stop> inner_corner(const Stop& before, const Stop& after) const;

  const Mask& mask_;
  std::vector<Stop> stops_;
};

/// At a concave corner a walk leaves one pixel and comes to another that touches it diagonally. The
/// mask pixel between the two has a corner at the same place, and one vertex there is enough. There
/// is no such pixel where only the diagonal joins them: then the walk needs both its stops.
std::optional<Stop> Walks::inner_corner(const Stop& before, const Stop& after) const {
  if (before.bridge || after.bridge) return std::nullopt;
  if (std::abs(after.row - before.row) != 1 || std::abs(after.column - before.column) != 1) {
    return std::nullopt;
  }
  Stop inner = before;
  if (mask_.at(before.row, after.column)) {
    inner.column = after.column;
    inner.east = !before.east;
    return inner;
  }
  if (mask_.at(after.row, before.column)) {
    inner.row = after.row;
    inner.south = !before.south;
    return inner;
  }
  return std::nullopt;
}

/// Whether b lies on the straight line from a to c and between them.
bool is_between(const Vertex& a, const Vertex& b, const Vertex& c) {
  if (a.x == b.x && b.x == c.x) return (b.y > a.y) == (c.y > b.y);
  if (a.y == b.y && b.y == c.y) return (b.x > a.x) == (c.x > b.x);
  return false;
}

void append_vertex(Polygon& polygon, const Vertex& vertex) {
  if (!polygon.empty() && polygon.back() == vertex) return;
  const std::size_t count = polygon.size();
  if (count >= 2 && is_between(polygon[count - 2], polygon[count - 1], vertex)) {
    polygon.back() = vertex;
  } else {
    polygon.push_back(vertex);
  }
}

/// Drops what append_vertex cannot see: vertices that are needless where the end meets the
/// beginning.
void close_polygon(Polygon& polygon) {
  while (polygon.size() > 1 && polygon.back() == polygon.front()) polygon.pop_back();
  while (polygon.size() > 2 &&
         is_between(polygon[polygon.size() - 2], polygon.back(), polygon.front())) {
    polygon.pop_back();
  }
  if (polygon.size() > 2 && is_between(polygon.back(), polygon[0], polygon[1])) {
    polygon.erase(polygon.begin());
  }
}

Polygon Walks::polygon(std::size_t crack, const VertexPlacement& placement) const {
  std::vector<const Stop*> walk;
  std::size_t stop = 2 * crack;
  do {
    walk.push_back(&stops_[stop]);
    stop = stops_[stop].next;
  } while (stop != 2 * crack);

  const auto vertex = [&placement](const Stop& at) {
    return Vertex{at.column * kVerticesPerPixel + (at.east ? placement.high : placement.low),
                  at.row * kVerticesPerPixel + (at.south ? placement.high : placement.low)};
  };
  Polygon polygon;
  bool merged = inner_corner(*walk.back(), *walk.front()).has_value();
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const bool merged_into_last = merged;
    const auto inner = inner_corner(*walk[i], *walk[(i + 1) % walk.size()]);
    merged = inner.has_value();
    if (merged_into_last) continue;
    append_vertex(polygon, vertex(inner ? *inner : *walk[i]));
  }
  close_polygon(polygon);
  return polygon;
}

/// The parts of a mask: outer rings with the holes that were joined to them.
struct Parts {
  std::vector<std::size_t> outer_rings;
  std::vector<std::size_t> part_of_ring;
};

struct HoleTop {
  Crack crack;  ///< the bottom side of the mask pixel above the hole's first pixel
  std::size_t crack_index;
  std::size_t ring;
};

HoleTop find_hole_top(const Boundary& boundary, std::size_t ring_index) {
  const CrackRing& ring = boundary.rings[ring_index];
  std::optional<HoleTop> top;
  for (std::size_t k = ring.first; k < ring.first + ring.count; ++k) {
    const Crack& crack = boundary.cracks[k];
    if (crack.side != Side::kBottom) continue;
    if (!top || crack.row < top->crack.row ||
        (crack.row == top->crack.row && crack.column < top->crack.column)) {
      top = HoleTop{crack, k, ring_index};
    }
  }
  return *top;
}

/// Joins each hole to the ring that is met first on the way straight up from the hole's top.
/// That ring reaches higher than the hole, so holes that are joined from the top down always meet a
/// ring that is joined already.
Parts join_holes(const Mask& mask, const Boundary& boundary, Walks& walks) {
  Parts parts;
  parts.part_of_ring.assign(boundary.rings.size(), 0);
  std::vector<HoleTop> holes;
  for (std::size_t i = 0; i < boundary.rings.size(); ++i) {
    if (boundary.rings[i].hole) {
      holes.push_back(find_hole_top(boundary, i));
    } else {
      parts.part_of_ring[i] = parts.outer_rings.size();
      parts.outer_rings.push_back(i);
    }
  }
  std::sort(holes.begin(), holes.end(), [](const HoleTop& a, const HoleTop& b) {
    return a.crack.row != b.crack.row ? a.crack.row < b.crack.row : a.crack.column < b.crack.column;
  });
  for (const HoleTop& hole : holes) {
    int row = hole.crack.row;
    while (mask.at(row - 1, hole.crack.column)) --row;
    const std::size_t above = boundary.top_crack(row, hole.crack.column);
    walks.join(above, hole.crack_index);
    parts.part_of_ring[hole.ring] = parts.part_of_ring[boundary.ring_of_crack[above]];
  }
  return parts;
}

}  // namespace

std::vector<BoundaryRing> boundary_rings(const Mask& mask) {
  const Boundary boundary = trace_boundary(mask);
  const Walks walks(mask, boundary);
  std::vector<BoundaryRing> rings;
  for (const CrackRing& ring : boundary.rings) {
    rings.push_back({ring.hole, walks.polygon(ring.first, kOnPixelEdges)});
  }
  return rings;
}

std::vector<Polygon> part_polygons(const Mask& mask, const VertexPlacement& placement) {
  const Boundary boundary = trace_boundary(mask);
  Walks walks(mask, boundary);
  const Parts parts = join_holes(mask, boundary, walks);
  std::vector<Polygon> polygons;
  for (const std::size_t ring : parts.outer_rings) {
    polygons.push_back(walks.polygon(boundary.rings[ring].first, placement));
  }
  return polygons;
}

WholePolygon whole_polygon(const Mask& mask, const VertexPlacement& placement) {
  const Boundary boundary = trace_boundary(mask);
  if (boundary.rings.empty()) return {};
  Walks walks(mask, boundary);
  const Parts parts = join_holes(mask, boundary, walks);
  const std::vector<PartBridge> bridges =
      bridge_parts(mask, boundary, parts.part_of_ring, parts.outer_rings.size());
  const WorthwhileParts worthwhile =
      worthwhile_parts(boundary, parts.part_of_ring, parts.outer_rings.size(), bridges);
  const auto kept = [&](std::size_t crack) {
    return worthwhile.kept[parts.part_of_ring[boundary.ring_of_crack[crack]]];
  };
  for (const PartBridge& bridge : bridges) {
    if (kept(bridge.from_crack) && kept(bridge.to_crack)) {
      walks.join_parts(bridge.from_crack, bridge.to_crack);
    }
  }
  const auto first = std::find(worthwhile.kept.begin(), worthwhile.kept.end(), true);
  const std::size_t ring =
      parts.outer_rings[static_cast<std::size_t>(first - worthwhile.kept.begin())];
  return {walks.polygon(boundary.rings[ring].first, placement), worthwhile.left_out_px};
}

}  // namespace seedframe
