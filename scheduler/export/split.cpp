#include "export/split.h"

#include "base/philox.h"

namespace seedframe {

const char* split_name(Split split) { return split == Split::kTrain ? "train" : "val"; }

Split split_of_scene(int scene, const ExportOptions& options) {
  const PhiloxStream stream(options.seed, "export/split");
  const double draw = stream.uniform({.scene = static_cast<std::uint32_t>(scene)});
  return draw < options.val_share ? Split::kVal : Split::kTrain;
}

}  // namespace seedframe
