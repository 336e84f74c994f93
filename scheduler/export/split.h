// Which frames train, which validate, which test.
#pragma once

#include <cstdint>
#include <vector>

#include "export/export_options.h"

namespace seedframe {

/// Index into `splits` by a draw of the stream "export/split" keyed by the scene alone: frames of
/// one scene, which look alike, stay together, and adding frames or scenes moves no scene to
/// another split. The shares are laid out from 0 with the first one, train, last.
int split_of_scene(int scene, std::uint64_t seed, const std::vector<SplitShare>& splits);

}  // namespace seedframe
