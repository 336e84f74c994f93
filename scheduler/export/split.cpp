#include "export/split.h"

#include "base/philox.h"

namespace seedframe {

int split_of_scene(int scene, std::uint64_t seed, const std::vector<SplitShare>& splits) {
  const PhiloxStream stream(seed, "export/split");
  const double draw = stream.uniform({.scene = static_cast<std::uint32_t>(scene)});
  double end = 0.0;
  for (std::size_t i = 1; i < splits.size(); ++i) {
    end += splits[i].share;
    if (draw < end) return static_cast<int>(i);
  }
  return 0;
}

}  // namespace seedframe
