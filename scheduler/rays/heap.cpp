#include "rays/heap.h"

#include <algorithm>
#include <numeric>

#include "rays/height_map.h"

namespace seedframe {

std::vector<double> heaped_up(const std::vector<Heaped>& things) {
  std::vector<std::size_t> order(things.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return things[a].falls < things[b].falls;  // none comes before any number
  });
  std::vector<double> raised(things.size(), 0.0);
  std::vector<HeightMap> tops;
  tops.reserve(things.size());
  for (const std::size_t i : order) {
    Eigen::Affine3d pose = things[i].world_from_object;
    if (things[i].falls) {
      const HeightMap bottom(*things[i].mesh, pose, HeightMap::Side::kBelow);
      for (const HeightMap& top : tops) raised[i] = std::max(raised[i], overlap_of(top, bottom));
      pose.translation().z() += raised[i];
    }
    tops.emplace_back(*things[i].mesh, pose, HeightMap::Side::kAbove);
  }
  return raised;
}

}  // namespace seedframe
