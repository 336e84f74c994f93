#include "export/dataset.h"

#include <algorithm>

namespace seedframe {
namespace {

void add_pairs(const std::vector<std::array<std::string, 2>>& pairs,
               const std::vector<std::string>& names, std::vector<std::array<int, 2>>& out) {
  const auto index = [&](const std::string& name) {
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (const auto& [from, to] : pairs) {
    const std::array<int, 2> pair = {index(from), index(to)};
    if (std::find(out.begin(), out.end(), pair) == out.end()) out.push_back(pair);
  }
}

}  // namespace

std::vector<ClassKeypoints> class_keypoints(const std::vector<OfferedAsset>& assets,
                                            const std::vector<std::string>& categories) {
  std::vector<ClassKeypoints> keypoints(categories.size());
  for (std::size_t k = 0; k < categories.size(); ++k) {
    ClassKeypoints& points = keypoints[k];
    for (const OfferedAsset& offered : assets) {
      if (offered.categories.count(categories[k]) == 0) continue;
      const KeypointSet& set = offered.asset->keypoints;
      for (const Keypoint& point : set.points) {
        if (std::find(points.names.begin(), points.names.end(), point.name) == points.names.end()) {
          points.names.push_back(point.name);
        }
      }
      add_pairs(set.skeleton, points.names, points.skeleton);
      add_pairs(set.mirrored, points.names, points.mirrored);
    }
  }
  return keypoints;
}

}  // namespace seedframe
