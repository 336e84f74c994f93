// Which patches an export takes when it takes the same number of every class.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "export/export_options.h"

namespace seedframe {

/// A patch that a frame has.
struct PatchCandidate {
  std::int64_t frame = 0;
  int split = 0;
  int category = 0;
  /// An instance's id, or -1, -2, … for the frame's windows onto the category.
  int number = 0;
  std::uint64_t draw = 0;  ///< of its own
};

/// Which of a split's patches are asked for: `per_class` divided by the splits' shares, rounded so
/// that the sum is kept.
std::vector<int> patches_of_splits(int per_class, const std::vector<SplitShare>& splits);

struct PatchDemand {
  int per_class = 0;
  std::vector<SplitShare> splits;
  std::vector<int> categories;           ///< that are asked for
  std::vector<std::string> class_names;  ///< of all; that of category k is class_names[k - 1]
  std::int64_t frames = 0;               ///< that the candidates come from
  std::string campaign;
};

/// The chosen of one frame: category and number, sorted.
using ChosenPatches = std::vector<std::pair<int, int>>;

/// By frame. Of each class and split exactly what is asked for: first one of every frame, by the
/// candidates' draws, then second ones, so that they come from as many frames as there are. A
/// kInput error lists what was found of each class and about how many more frames there should be.
Result<std::map<std::int64_t, ChosenPatches>> choose_patches(std::vector<PatchCandidate> candidates,
                                                             const PatchDemand& demand);

}  // namespace seedframe
