#include "rays/heap.h"

#include <algorithm>
#include <numeric>

#include "rays/height_map.h"

namespace seedframe {
namespace {

/// Without an owner, another mesh may have come to the same place.
bool is_known(const Heaped& a, const Heaped& b) {
  const bool stays = a.mesh == nullptr || a.owner != nullptr;
  return stays && a.owner == b.owner && a.mesh == b.mesh && a.falls == b.falls &&
         a.world_from_object.matrix() == b.world_from_object.matrix();
}

std::vector<double> computed(const std::vector<Heaped>& things) {
  std::vector<std::size_t> order(things.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return things[a].falls < things[b].falls;  // none comes before any number
  });
  std::vector<double> raised(things.size(), 0.0);
  std::vector<HeightMap> tops;
  tops.reserve(things.size());
  for (const std::size_t i : order) {
    if (things[i].mesh == nullptr) continue;
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

}  // namespace

std::vector<double> heaped_up(const std::vector<Heaped>& things) {
  thread_local std::vector<Heaped> last_things;
  thread_local std::vector<double> last_raised;
  if (!std::equal(things.begin(), things.end(), last_things.begin(), last_things.end(), is_known)) {
    last_raised = computed(things);
    last_things = things;
  }
  return last_raised;
}

}  // namespace seedframe
